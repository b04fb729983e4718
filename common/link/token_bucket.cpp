// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/token_bucket.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::link {

TokenBucket::TokenBucket(HostTime start, const std::vector<double>& at_s, std::vector<double> bytes_per_s,
                         std::size_t burst_bytes)
    : bytes_per_s_(std::move(bytes_per_s)),
      burst_bytes_(static_cast<double>(burst_bytes)),
      tokens_(burst_bytes_),
      counted_(start) {
  for (const double at : at_s) changes_.push_back(start + from_seconds(at));
}

std::optional<double> TokenBucket::rate_at(HostTime t) const {
  const auto next = std::upper_bound(changes_.begin(), changes_.end(), t);
  if (next == changes_.begin()) return std::nullopt;
  return bytes_per_s_[static_cast<std::size_t>(next - changes_.begin()) - 1];
}

double TokenBucket::passed_between(HostTime from, HostTime to) const {
  double bytes = 0.0;
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const HostTime begin = std::max(from, changes_[i]);
    const HostTime end = i + 1 < changes_.size() ? std::min(to, changes_[i + 1]) : to;
    if (end > begin) bytes += bytes_per_s_[i] * to_seconds(end - begin);
  }
  return bytes;
}

double TokenBucket::tokens_at(HostTime t, double most) const {
  return std::min(most, tokens_ + passed_between(counted_, t));
}

HostTime TokenBucket::ready_at(std::size_t bytes, HostTime now) const {
  if (!rate_at(now)) return now;
  now = std::max(now, counted_);
  const auto need = static_cast<double>(bytes);
  double missing = need - tokens_at(now, std::max(burst_bytes_, need));
  // Walk through the schedule until the missing tokens have come.
  HostTime t = now;
  while (missing > 0.0) {
    const double rate = *rate_at(t);
    const auto change = std::upper_bound(changes_.begin(), changes_.end(), t);
    const double here = change == changes_.end() ? missing : rate * to_seconds(*change - t);
    if (here >= missing) return rate > 0.0 ? t + from_seconds(missing / rate) : HostTime::max();
    missing -= here;
    t = *change;
  }
  return t;
}

void TokenBucket::take(std::size_t bytes, HostTime t, std::size_t head_bytes) {
  if (!rate_at(t)) return;
  const auto taken = static_cast<double>(bytes);
  const double most = std::max(burst_bytes_, static_cast<double>(head_bytes));
  tokens_ = std::min(most, tokens_at(t, std::max(most, taken)) - taken);
  counted_ = std::max(counted_, t);
}

}  // namespace edgesplat::link
