// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/metrics/registry.hpp"
#include "common/time/clock.hpp"
#include "robot/config/robot_config.hpp"
#include "robot/sync/pps_capture.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>

namespace edgesplat::app {

struct PpsInputCounters {
  std::uint64_t told = 0;  ///< edges that went to the sink
  std::uint64_t off_second =
      0;                       ///< edges nowhere near a full second: the wall clock is wrong, or the setting
  std::uint64_t stale = 0;     ///< edges that were read too late, or before the wall clock was set
  std::uint64_t failures = 0;  ///< of the device: opened anew
};

/// The pulse-per-second line: its good edges, each with the moment of UTC it was, to whoever tells a LiDAR.
/// One line in the log when pulses come, stop or make no sense. receive() and publish_counters() belong to
/// one thread at a time.
class PpsInput {
 public:
  /// Waits for the next edge; as PpsDevice::wait. After an error it is called again a second later.
  using Wait = std::function<Result<std::optional<sync::PpsEdge>>(double timeout_s)>;
  using Sink = std::function<void(HostTime edge, std::int64_t utc_ns)>;

  /// Errors: those of PpsDevice::open. A device that fails later is opened anew.
  static Result<PpsInput> open(const robot_config::PpsSettings& config, const Clock& clock);
  /// `wall_ns`: the clock that edges are stamped with.
  PpsInput(const robot_config::PpsSettings& config, Wait wait, const Clock& clock,
           std::function<std::int64_t()> wall_ns)
      : config_(config), wait_(std::move(wait)), clock_(&clock), wall_ns_(std::move(wall_ns)) {}

  /// Until `stop` is requested.
  void receive(const std::stop_token& stop, const Sink& sink);
  /// "pps.*".
  void publish_counters(metrics::Registry& metrics) const;
  [[nodiscard]] const PpsInputCounters& counters() const { return counters_; }

 private:
  void on_edge(const sync::PpsEdge& edge, const Sink& sink);
  void note(bool in_order, const char* why);

  robot_config::PpsSettings config_;
  Wait wait_;
  const Clock* clock_;
  std::function<std::int64_t()> wall_ns_;
  sync::PpsTrack track_;
  std::optional<bool> in_order_;
  PpsInputCounters counters_;
};

}  // namespace edgesplat::app
