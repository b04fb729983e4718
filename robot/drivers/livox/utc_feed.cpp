// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/utc_feed.hpp"

#include <utility>

namespace edgesplat::livox {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

}  // namespace

void UtcFeed::on_pulse(HostTime edge, std::int64_t utc_ns) {
  if (utc_ns == told_ns_) return;
  if (edge_ && utc_ns != utc_ns_) ++missed_;
  edge_ = edge;
  utc_ns_ = utc_ns;
}

void UtcFeed::follow_wall_clock(HostTime now, std::int64_t wall_ns) {
  const std::int64_t since_edge_ns = wall_ns % kSecond_ns;
  on_pulse(now - nanoseconds(since_edge_ns), wall_ns - since_edge_ns);
}

std::optional<std::int64_t> UtcFeed::due(HostTime now) {
  if (!edge_ || now < *edge_ + kSendAfter) return std::nullopt;
  const bool in_time = now <= *edge_ + kLatest;
  told_edge_ = std::exchange(edge_, std::nullopt);
  told_ns_ = utc_ns_;
  if (in_time) return utc_ns_;
  ++missed_;
  return std::nullopt;
}

}  // namespace edgesplat::livox
