// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <cstdint>
#include <optional>

namespace edgesplat::livox {

/// Tells a LiDAR on a pulse-per-second line which second each pulse began. The telling must reach an Avia 10
/// to 500 ms after the pulse and a Mid-360 0 to 430 ms after it; this one aims at 200 ms and leaves out a
/// second for which it is later than 300 ms. Pure. Single-owner. Source: sensor-protocols sheet, 1.7, 2.4, 4.
class UtcFeed {
 public:
  static constexpr nanoseconds kSendAfter = std::chrono::milliseconds(200);
  static constexpr nanoseconds kLatest = std::chrono::milliseconds(300);

  /// A rising edge, seen at `edge`, which is `utc_ns` since 1970.
  void on_pulse(HostTime edge, std::int64_t utc_ns);
  /// The pulses are on whole seconds of UTC and this machine's wall clock is right to 0.2 s: no edge has to
  /// be seen.
  void follow_wall_clock(HostTime now, std::int64_t wall_ns);
  /// What the last edge was, ns since 1970, when it is the moment to say so; once for each edge.
  [[nodiscard]] std::optional<std::int64_t> due(HostTime now);
  /// Nobody is there to be told the last edge.
  void skip() { edge_.reset(); }
  /// When due() has to be asked again: for this edge, or since the next one comes.
  [[nodiscard]] HostTime next_due() const {
    if (edge_) return *edge_ + kSendAfter;
    return told_edge_ ? *told_edge_ + std::chrono::seconds(1) : HostTime::max();
  }
  /// Edges that were not told in time.
  [[nodiscard]] std::uint64_t missed() const { return missed_; }

 private:
  std::optional<HostTime> edge_;  ///< not told yet
  std::optional<HostTime> told_edge_;
  std::int64_t utc_ns_ = 0;
  std::int64_t told_ns_ = 0;
  std::uint64_t missed_ = 0;
};

}  // namespace edgesplat::livox
