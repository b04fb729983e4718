// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/offload/recent_values.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace edgesplat::offload {

void RecentValues::add(double value, HostTime now) {
  values_.push_back({value, now});
  if (values_.size() > kMost) values_.pop_front();
  forget_old(now);
}

void RecentValues::forget_old(HostTime now) {
  while (!values_.empty() && now - values_.front().at > window_) values_.pop_front();
}

std::optional<double> RecentValues::p95(HostTime now) {
  forget_old(now);
  if (values_.empty()) return std::nullopt;
  std::vector<double> sorted;
  sorted.reserve(values_.size());
  for (const Value& value : values_) sorted.push_back(value.value);
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.95 * static_cast<double>(sorted.size()))) - 1;
  std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
  return sorted[static_cast<std::size_t>(rank)];
}

std::optional<double> RecentValues::largest(HostTime now) {
  forget_old(now);
  if (values_.empty()) return std::nullopt;
  const auto most = std::max_element(values_.begin(), values_.end(),
                                     [](const Value& a, const Value& b) { return a.value < b.value; });
  return most->value;
}

}  // namespace edgesplat::offload
