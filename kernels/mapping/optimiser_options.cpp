// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/optimiser_options.hpp"

#include <array>
#include <string>

namespace edgesplat::mapping {
namespace {

struct Range {
  const char* name;
  float value, low, high;
};

}  // namespace

Status OptimiserOptions::validate() const {
  if (sh_degree < 0 || sh_degree > 3) return fail(Errc::kInvalidConfig, "sh_degree must be 0..3");
  if (max_gaussians < 1 || max_gaussians > (std::size_t{1} << 31U))
    return fail(Errc::kInvalidConfig, "max_gaussians must be 1..2^31");
  const std::array ranges{
      Range{"rates.mean_m", rates.mean_m, 0.0F, 1.0F},
      Range{"rates.log_scale", rates.log_scale, 0.0F, 1.0F},
      Range{"rates.quat", rates.quat, 0.0F, 1.0F},
      Range{"rates.opacity_logit", rates.opacity_logit, 0.0F, 1.0F},
      Range{"rates.sh_base", rates.sh_base, 0.0F, 1.0F},
      Range{"rates.sh_rest", rates.sh_rest, 0.0F, 1.0F},
      Range{"adam.beta1", adam.beta1, 0.0F, 0.9999F},
      Range{"adam.beta2", adam.beta2, 0.0F, 0.99999F},
      Range{"adam.mean_final_share", adam.mean_final_share, 0.0F, 1.0F},
      Range{"adam.mean_decay_steps", adam.mean_decay_steps, 1.0F, 1e6F},
      Range{"exposure.rate", exposure.rate, 0.0F, 0.05F},
      Range{"exposure.pull", exposure.pull, 0.0F, 1.0F},
      Range{"ssim_share", ssim_share, 0.0F, 1.0F},
      Range{"depth_factor", depth_factor, 0.0F, 10.0F},
      Range{"depth_min_alpha", depth_min_alpha, 0.05F, 1.0F},
      Range{"gap_factor", gap_factor, 0.0F, 1.0F},
      Range{"opacity_factor", opacity_factor, 0.0F, 10.0F},
      Range{"prune.factor", prune.factor, 0.0F, 10.0F},
      Range{"prune.rate", prune.rate, 1e-3F, 1.0F},
      Range{"prune.start", prune.start, 0.5F, 0.99F},
      Range{"prune.min_switch", prune.min_switch, 0.0F, 0.5F},
      Range{"scale_factor", scale_factor, 0.0F, 10.0F},
  };
  for (const Range& range : ranges) {
    // Written so that NaN is refused too.
    if (range.value >= range.low && range.value <= range.high) continue;
    return fail(Errc::kInvalidConfig, std::string(range.name) + " must be " + std::to_string(range.low) +
                                          ".." + std::to_string(range.high) + ", not " +
                                          std::to_string(range.value));
  }
  return {};
}

}  // namespace edgesplat::mapping
