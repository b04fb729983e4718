// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/gaussian_values.hpp"

#include <string>

namespace edgesplat::io {

Status check_writable(const gaussian::GaussianCloud& cloud) {
  if (!cloud.consistent()) {
    return fail(Errc::kInvalidArgument, "a Gaussian cloud with arrays of different lengths");
  }
  for (const auto* values :
       {&cloud.means_m, &cloud.log_scales, &cloud.quats_xyzw, &cloud.opacity_logits, &cloud.sh}) {
    for (std::size_t i = 0; i < values->size(); ++i) {
      if (std::isfinite((*values)[i])) continue;
      return fail(Errc::kInvalidArgument,
                  "Gaussian " + std::to_string(i / (values->size() / cloud.size())) + " is not finite");
    }
  }
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    const float* q = &cloud.quats_xyzw[4 * row];
    if (q[0] == 0.0F && q[1] == 0.0F && q[2] == 0.0F && q[3] == 0.0F) {
      return fail(Errc::kInvalidArgument, "Gaussian " + std::to_string(row) + " has no rotation");
    }
  }
  return {};
}

}  // namespace edgesplat::io
