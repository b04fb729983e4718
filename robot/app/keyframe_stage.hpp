// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/metrics/registry.hpp"
#include "common/time/clock.hpp"
#include "robot/app/keyframe_album.hpp"
#include "robot/app/run_log.hpp"
#include "robot/config/robot_config.hpp"
#include "robot/keyframe/coloured_map.hpp"
#include "robot/keyframe/hold_out.hpp"
#include "robot/keyframe/keyframe_builder.hpp"
#include "robot/sync/camera_offset.hpp"

#include <functional>
#include <memory>
#include <optional>

namespace edgesplat::app {

/// A pose with the picture it was taken at: what the tracking stage hands on.
struct TrackedFrame {
  tracking::TrackedGroup group;
  std::optional<sync::GroupImage> image;
  int points_in_group = 0;
  double track_ms = 0.0;
  double latency_ms = 0.0;  ///< group complete -> pose known, waiting included
};

/// Last stage of the sensing chain: keeps the run's log, makes keyframes and hands them on; pictures that the
/// configuration holds out go into the album alone (keyframes.held_out). `work_clock`
/// measures what a stage costs (real time also in a lockstep run). Single-owner.
class KeyframeStage {
 public:
  using KeyframeSink = std::function<void(std::shared_ptr<const map::Keyframe>)>;

  KeyframeStage(const robot_config::RobotConfig& config, const sensor::Rig& rig, KeyframeSink sink,
                const Clock& work_clock, metrics::Registry& metrics);

  void operator()(const TrackedFrame& frame);

  [[nodiscard]] const RunLog& log() const { return log_; }
  [[nodiscard]] const KeyframeAlbum& album() const { return album_; }
  [[nodiscard]] const keyframe::ColouredMap& coloured_map() const { return coloured_map_; }

 private:
  /// Whether the picture's time can be trusted; looks at every picture.
  [[nodiscard]] bool in_sync(const TrackedFrame& frame);
  /// Null: no keyframe at this moment.
  Result<std::shared_ptr<const map::Keyframe>> make(const TrackedFrame& frame);

  keyframe::KeyframeBuilder builder_;
  keyframe::HoldOut hold_out_;
  std::optional<sync::CameraOffset> camera_offset_;
  KeyframeSink sink_;
  const Clock& work_clock_;
  metrics::Counter& made_;
  metrics::Counter& held_out_;
  metrics::Counter& failed_;
  metrics::Counter& out_of_sync_;
  metrics::Counter& offset_alarms_;
  metrics::Gauge& offset_ms_;
  metrics::Gauge& offset_sigma_ms_;
  metrics::Counter& points_;
  metrics::Histogram& keyframe_ms_;
  metrics::Histogram& latency_ms_;
  RunLog log_;
  KeyframeAlbum album_;
  keyframe::ColouredMap coloured_map_;
};

}  // namespace edgesplat::app
