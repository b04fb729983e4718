// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/app/keyframe_stage.hpp"
#include "robot/config/robot_config.hpp"
#include "robot/sync/group_builder.hpp"
#include "robot/tracking/pose_stream.hpp"
#include "robot/tracking/tracker.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace edgesplat::app {

/// A group that waits to be tracked.
struct ReadyGroup {
  sync::MeasureGroup group;
  HostTime ready{};  ///< when it was complete, on the work clock
};

/// The three algorithms between a measurement and a keyframe, wired but without threads: the lockstep run
/// calls them one after the other, the live run gives each a worker. Each function belongs to one thread at a
/// time.
class SensingChain {
 public:
  /// kInvalidConfig from the tracker's checks.
  static Result<std::unique_ptr<SensingChain>> create(const robot_config::RobotConfig& config,
                                                      const sensor::Rig& rig,
                                                      KeyframeStage::KeyframeSink sink,
                                                      const Clock& work_clock, metrics::Registry& metrics);

  /// A pose at each sample of the IMU, as soon as it is there, with the sample's arrival; called within
  /// sync().
  using PoseSink = std::function<void(const tracking::StreamedPose&, HostTime arrival)>;
  void stream_poses_to(PoseSink sink) { pose_sink_ = std::move(sink); }

  /// As of Tracker: the Gaussian map that poses are held against where the configuration asks for it.
  void look_at(std::shared_ptr<tracking::GaussianView> map) { tracker_->look_at(std::move(map)); }

  [[nodiscard]] std::vector<ReadyGroup> sync(sensor::Measurement measurement);
  [[nodiscard]] std::vector<ReadyGroup> flush();
  /// Nothing for a group that tracking refused (counted and logged).
  [[nodiscard]] std::optional<TrackedFrame> track(ReadyGroup ready);
  void keyframe(const TrackedFrame& frame) { keyframe_stage_(frame); }

  [[nodiscard]] const KeyframeStage& keyframes() const { return keyframe_stage_; }
  /// Copies the modules' own counters into the registry; call when the stages stand still.
  void publish_counters(metrics::Registry& metrics) const;

 private:
  SensingChain(const robot_config::RobotConfig& config, const sensor::Rig& rig,
               std::unique_ptr<tracking::Tracker> tracker, KeyframeStage::KeyframeSink sink,
               const Clock& work_clock, metrics::Registry& metrics);

  void watch_clocks();
  void stream_pose(const sync::GroupImu& sample);

  const Clock& work_clock_;
  sync::GroupBuilder group_builder_;
  std::unique_ptr<tracking::Tracker> tracker_;
  tracking::PoseStream pose_stream_;
  PoseSink pose_sink_;
  HostTime sample_arrival_{};  ///< of the measurement that sync() has in hand
  KeyframeStage keyframe_stage_;
  std::uint64_t clock_lies_ = 0;  ///< said so far
  tracking::SensorOffsets offsets_;
  metrics::Histogram& track_ms_;
  metrics::Counter& refused_groups_;
  metrics::Counter& streamed_poses_;
};

}  // namespace edgesplat::app
