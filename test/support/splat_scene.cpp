// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/splat_scene.hpp"

#include "test/support/random.hpp"

#include <cmath>

namespace edgesplat::test {
namespace {

/// Of the longest axis, so that the projected one is 2 px: measured with the axes and turns below.
constexpr double kMedianLongest_px = 2.52;
constexpr double kSpreadOfLog = 0.5;

void fill_shape(Random& random, double m_per_px, std::size_t row, gaussian::GaussianCloud& cloud) {
  const double longest_m = m_per_px * kMedianLongest_px * std::exp(kSpreadOfLog * random.normal());
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = k == 0 ? 1.0 : random.uniform(0.3, 1.0);
    cloud.log_scales[3 * row + k] = static_cast<float>(std::log(longest_m * share));
  }
  const Eigen::Quaternionf q = random.rotation().cast<float>();
  for (std::size_t k = 0; k < 4; ++k)
    cloud.quats_xyzw[4 * row + k] = q.coeffs()[static_cast<Eigen::Index>(k)];
}

void fill_colour(Random& random, std::size_t row, gaussian::GaussianCloud& cloud) {
  const double opacity = random.uniform(0.05, 0.95);
  cloud.opacity_logits[row] = static_cast<float>(std::log(opacity / (1.0 - opacity)));
  const std::size_t floats = cloud.sh_floats_each();
  for (std::size_t k = 0; k < floats; ++k) {
    const double half = k < 3 ? 1.5 : 0.1;
    cloud.sh[floats * row + k] = static_cast<float>(random.uniform(-half, half));
  }
}

}  // namespace

SplatScene splat_scene(const SplatSceneShape& shape) {
  const double focal_px = 0.8 * shape.width_px;
  SplatScene scene;
  scene.camera = {geometry::CameraKind::kPinhole,
                  shape.width_px,
                  shape.height_px,
                  focal_px,
                  focal_px,
                  0.5 * shape.width_px,
                  0.5 * shape.height_px,
                  {}};
  Random random(shape.seed);
  gaussian::GaussianCloud& cloud = scene.cloud;
  cloud.sh_degree = shape.sh_degree;
  cloud.resize(shape.count);
  for (std::size_t row = 0; row < shape.count; ++row) {
    cloud.ids[row] = gaussian::GaussianId(1, row + 1);
    const double z = random.uniform(1.0, 10.0);
    const double x = random.uniform(-0.5, 0.5) * shape.width_px / focal_px * z;
    const double y = random.uniform(-0.5, 0.5) * shape.height_px / focal_px * z;
    const auto sector = static_cast<double>(row % static_cast<std::size_t>(shape.share));
    const double turn = 2.0 * 3.14159265358979 * sector / shape.share;
    cloud.means_m[3 * row] = static_cast<float>(std::cos(turn) * x + std::sin(turn) * z);
    cloud.means_m[3 * row + 1] = static_cast<float>(y);
    cloud.means_m[3 * row + 2] = static_cast<float>(-std::sin(turn) * x + std::cos(turn) * z);
    fill_shape(random, z / focal_px, row, cloud);
    fill_colour(random, row, cloud);
  }
  return scene;
}

}  // namespace edgesplat::test
