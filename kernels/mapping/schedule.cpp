// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/schedule.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace edgesplat::mapping {

Status ScheduleOptions::validate() const {
  if (sh_degree < 0 || sh_degree > 3) return fail(Errc::kInvalidConfig, "sh_degree must be 0..3");
  struct Range {
    const char* name;
    double value, low;
  };
  const std::array ranges{Range{"coarse_until", coarse_until, 0.0},
                          Range{"sh_from", sh_from, 0.0},
                          Range{"sh_every", sh_every, 0.0},
                          Range{"cool_from", cool_from, 0.0},
                          Range{"grow_from", grow_from, 0.0},
                          Range{"grow_until", grow_until, 0.0},
                          Range{"cool_to", static_cast<double>(cool_to), 1e-4}};
  for (const Range& range : ranges) {
    // Written so that NaN is refused too.
    if (range.value >= range.low && range.value <= 1.0) continue;
    return fail(Errc::kInvalidConfig, std::string(range.name) + " must be " + std::to_string(range.low) +
                                          "..1, not " + std::to_string(range.value));
  }
  return {};
}

int Schedule::shrink(double progress) const {
  return progress < options_.coarse_until ? 2 : 1;
}

int Schedule::sh_degree(double progress) const {
  if (progress < options_.sh_from) return 0;
  if (options_.sh_every <= 0.0) return options_.sh_degree;
  const double more = (std::min(progress, 1.0) - options_.sh_from) / options_.sh_every;
  return std::min(options_.sh_degree, 1 + static_cast<int>(more));
}

float Schedule::rate_share(double progress) const {
  if (progress <= options_.cool_from || options_.cool_from >= 1.0) return 1.0F;
  const double way = (std::min(progress, 1.0) - options_.cool_from) / (1.0 - options_.cool_from);
  return std::pow(options_.cool_to, static_cast<float>(way));
}

bool Schedule::grows(double progress) const {
  return progress >= options_.grow_from && progress < options_.grow_until;
}

train::LearningRates scaled(const train::LearningRates& rates, float share) {
  train::LearningRates out = rates;
  for (float* rate : {&out.mean_m, &out.log_scale, &out.quat, &out.opacity_logit, &out.sh_base, &out.sh_rest})
    *rate *= share;
  return out;
}

}  // namespace edgesplat::mapping
