// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/local_mapping/importance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace edgesplat::local_mapping {
namespace {

/// Nearer than this all count alike: a picture does not show them as a whole.
constexpr float kNear_m = 1.0F;

/// Logarithm of what a row fills.
float importance(const gaussian::GaussianCloud& cloud, std::size_t row, const Eigen::Vector3f& near_m) {
  const float* mean = &cloud.means_m[3 * row];
  const float* log_scale = &cloud.log_scales[3 * row];
  const float distance_m = std::max(kNear_m, (Eigen::Vector3f(mean[0], mean[1], mean[2]) - near_m).norm());
  const float smallest = std::min({log_scale[0], log_scale[1], log_scale[2]});
  const float log_face = log_scale[0] + log_scale[1] + log_scale[2] - smallest;
  const float log_opacity = -std::log1p(std::exp(-cloud.opacity_logits[row]));
  return log_opacity + log_face - 2.0F * std::log(distance_m);
}

}  // namespace

std::vector<std::uint32_t> least_important(const gaussian::GaussianCloud& cloud,
                                           const Eigen::Vector3f& near_m, std::size_t count) {
  std::vector<std::pair<float, std::uint32_t>> ranked(cloud.size());
  for (std::uint32_t row = 0; row < ranked.size(); ++row) ranked[row] = {importance(cloud, row, near_m), row};
  count = std::min(count, ranked.size());
  const auto middle = ranked.begin() + static_cast<std::ptrdiff_t>(count);
  if (middle != ranked.end()) std::nth_element(ranked.begin(), middle, ranked.end());
  std::vector<std::uint32_t> rows;
  rows.reserve(count);
  for (auto it = ranked.begin(); it != middle; ++it) rows.push_back(it->second);
  std::sort(rows.begin(), rows.end());
  return rows;
}

}  // namespace edgesplat::local_mapping
