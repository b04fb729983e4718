// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/random_cloud.hpp"

#include <cmath>

namespace edgesplat::test {

gaussian::GaussianCloud random_cloud(Random& random, const CloudShape& shape) {
  gaussian::GaussianCloud cloud;
  cloud.sh_degree = shape.sh_degree;
  cloud.resize(shape.count);
  for (std::size_t i = 0; i < shape.count; ++i) {
    cloud.ids[i] = gaussian::GaussianId(1, i + 1);
    cloud.means_m[3 * i] = static_cast<float>(random.uniform(-shape.half_width_m, shape.half_width_m));
    cloud.means_m[3 * i + 1] = static_cast<float>(random.uniform(-shape.half_width_m, shape.half_width_m));
    cloud.means_m[3 * i + 2] = static_cast<float>(random.uniform(shape.near_m, shape.far_m));
    for (std::size_t k = 0; k < 3; ++k) {
      cloud.log_scales[3 * i + k] =
          static_cast<float>(random.uniform(std::log(shape.scale_min_m), std::log(shape.scale_max_m)));
    }
    const Eigen::Quaternionf q = random.rotation().cast<float>();
    for (std::size_t k = 0; k < 4; ++k)
      cloud.quats_xyzw[4 * i + k] = q.coeffs()[static_cast<Eigen::Index>(k)];
    cloud.opacity_logits[i] = static_cast<float>(random.uniform(-4.0, 4.0));
  }
  for (float& value : cloud.sh) value = static_cast<float>(random.uniform(-0.7, 0.7));
  return cloud;
}

}  // namespace edgesplat::test
