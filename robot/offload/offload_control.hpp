// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/heartbeat.hpp"
#include "common/link/transport.hpp"
#include "common/policy/offload_policy.hpp"
#include "common/time/clock.hpp"
#include "robot/offload/recent_values.hpp"

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>

namespace edgesplat::offload {

[[nodiscard]] link::OffloadMode to_link(policy::Mode mode);

/// Where the decision's measurements come from; each is asked once an evaluation.
struct OffloadSources {
  std::function<link::LinkQuality()> link;
  std::function<link::LinkCounters()> counters;
  std::function<std::uint64_t()> memory_bytes;
};

/// One evaluation with everything it rested on.
struct OffloadRecord {
  HostTime at{};
  policy::Decision decision;
  policy::Situation situation;
  std::optional<double> shaped_bytes_per_s;  ///< the truth where the link is impaired on purpose; for reports
  std::uint64_t bytes_up = 0;                ///< since the start
  std::uint64_t bytes_down = 0;
  bool draining = false;           ///< the run is over: what is left goes up at any cost
  bool offload_wanted = false;     ///< or done
  bool bandwidth_matters = false;  ///< a change of the bandwidth could change the decision: worth measuring
};

/// Gathers what Algorithm 1 needs over windows of 2 s and evaluates it. Thread-safe; evaluate() on one
/// thread.
class OffloadControl {
 public:
  OffloadControl(const policy::OffloadConfig& config, OffloadSources sources, const Clock& clock);

  void on_picture(double render_ms);
  /// `in_step`: the robot's map follows the server's, as far as the heartbeat tells.
  void on_server_heartbeat(bool in_step);
  /// Call every config.evaluation_period_s.
  OffloadRecord evaluate();
  /// Of the last evaluation.
  [[nodiscard]] OffloadRecord last() const;

 private:
  [[nodiscard]] bool offload_failed(const link::LinkCounters& counters);

  const policy::OffloadConfig config_;
  const OffloadSources sources_;
  const Clock& clock_;
  mutable std::mutex mutex_;
  policy::OffloadPolicy policy_;
  RecentValues render_ms_;
  RecentValues memory_bytes_;
  std::optional<HostTime> last_heartbeat_;
  bool in_step_ = false;
  bool resync_due_ = false;  ///< the server was lost: back only once the map is in step again
  std::uint64_t given_up_before_ = 0;
  OffloadRecord last_;
};

}  // namespace edgesplat::offload
