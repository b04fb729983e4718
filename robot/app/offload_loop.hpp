// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/thread/worker.hpp"
#include "robot/offload/local_mapping.hpp"
#include "robot/offload/mode_timeline.hpp"
#include "robot/offload/offload_control.hpp"
#include "robot/uplink/uplink.hpp"

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>

namespace edgesplat::app {

/// What the decision acts on; all must outlive the loop.
struct OffloadTargets {
  link::Transport& transport;
  uplink::Uplink& uplink;
  offload::LocalMapping* local = nullptr;  ///< null: none
};

/// Evaluates the offloading decision on a thread of its own and applies it: the uplink's mode, probing, the
/// robot's own mapping, the log and the timeline. Thread-safe.
class OffloadLoop {
 public:
  /// `timeline`: file to write, or empty. The first evaluation is made before this returns.
  OffloadLoop(offload::OffloadControl& control, const OffloadTargets& targets, double period_s,
              const std::filesystem::path& timeline, const Clock& clock);
  ~OffloadLoop();
  OffloadLoop(const OffloadLoop&) = delete;
  OffloadLoop& operator=(const OffloadLoop&) = delete;

  /// Hands a keyframe to the robot's own mapping where the mode is LOCAL.
  void submit(const std::shared_ptr<const map::Keyframe>& keyframe);
  /// The run is over: what the timeline says from now on is no drive any more.
  void begin_draining() { draining_ = true; }
  /// Mode changes so far.
  [[nodiscard]] std::uint64_t switches() const { return switches_.load(); }

 private:
  void evaluate();
  void log_change(const offload::OffloadRecord& record);

  offload::OffloadControl& control_;
  const OffloadTargets targets_;
  const nanoseconds period_;
  offload::ModeTimeline timeline_;
  std::atomic<std::uint64_t> switches_ = 0;
  std::atomic<bool> draining_ = false;
  std::mutex sleep_mutex_;
  std::condition_variable_any sleep_;
  std::optional<thread::Worker> worker_;
};

}  // namespace edgesplat::app
