// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <cstdint>
#include <deque>
#include <vector>

namespace edgesplat {

struct ClockMapConfig {
  double window_s = 10.0;   ///< arrivals older than this are forgotten, [1, 600]
  double min_span_s = 1.0;  ///< below this span only the offset is fitted, the rate stays 1, (0, window_s)
  double max_drift_ppm = 200.0;  ///< no crystal is worse: a steeper fit is held to this, (0, 10000]
  double jump_threshold_s =
      0.05;  ///< an arrival this much earlier than predicted, or a stamp that far back: reset
};

/// Online map from a device's clock to the host's: a line under the (stamp, arrival) points. A packet can
/// arrive late but never early, so the lower envelope of arrival - stamp is the clock relation plus the
/// smallest latency (a constant that cannot be seen from arrivals alone). In the synchronised mode (PTP, PPS)
/// stamps already are host time and pass unchanged. Every conversion of the project goes through here.
/// Single-owner; constant memory, O(64) a message. Source: ../shared/design/sensor-protocols.md 3.4;
/// libcamera's clock recovery does the same job.
class ClockMap {
 public:
  explicit ClockMap(ClockMapConfig config = {}) : config_(config) {}

  /// A map that passes stamps unchanged: the device's clock is disciplined to the host's.
  static ClockMap synchronised();

  /// Learns from one stamped message and the time it arrived. Ignored in the synchronised mode.
  void observe(SensorTime stamp, HostTime arrival);
  /// The stamp in host time. Before the first observation the stamp passes unchanged.
  [[nodiscard]] HostTime to_host(SensorTime stamp) const;
  /// Rate of the device's clock against the host's, parts per million; 0 until min_span_s was seen.
  [[nodiscard]] double drift_ppm() const;
  /// How often a clock jump forced a restart.
  [[nodiscard]] std::int64_t resets() const { return resets_; }
  [[nodiscard]] bool is_synchronised() const { return synchronised_; }

 private:
  struct Observation {
    std::int64_t stamp_ns;
    std::int64_t delay_ns;  ///< arrival - stamp
  };
  /// The least delayed message of one 64th of the window.
  struct Bin {
    std::int64_t index;
    Observation least;
  };
  [[nodiscard]] bool is_jump(const Observation& next) const;
  void keep_least(const Observation& next);
  void refit();
  /// The lowest line of this slope that touches the observations from below.
  void support(double slope);
  void reset();

  ClockMapConfig config_;
  bool synchronised_ = false;
  std::deque<Bin> bins_;           ///< oldest first, those of the window only
  std::vector<Observation> hull_;  ///< lower convex hull of the bins, scratch of refit()
  std::int64_t newest_stamp_ns_ = 0;
  std::int64_t anchor_stamp_ns_ = 0;
  std::int64_t anchor_delay_ns_ = 0;
  double slope_ = 0.0;  ///< d(delay)/d(stamp)
  std::int64_t resets_ = 0;
};

}  // namespace edgesplat
