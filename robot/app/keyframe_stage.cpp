// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/keyframe_stage.hpp"

#include "common/log/log.hpp"

namespace edgesplat::app {
namespace {

constexpr std::size_t kAlbumKeyframes = 24;
constexpr std::size_t kOffsetPoints = 3000;
constexpr double kColouredMapSpacingM = 0.04;
constexpr std::size_t kColouredMapPoints = 4'000'000;  // 64 MB

}  // namespace

KeyframeStage::KeyframeStage(const robot_config::RobotConfig& config, const sensor::Rig& rig,
                             KeyframeSink sink, const Clock& work_clock, metrics::Registry& metrics)
    : builder_(config.keyframe, rig),
      hold_out_(config.keyframe),
      sink_(std::move(sink)),
      work_clock_(work_clock),
      made_(metrics.counter("keyframes.made")),
      held_out_(metrics.counter("keyframes.held_out")),
      failed_(metrics.counter("keyframes.failed")),
      out_of_sync_(metrics.counter("sync.unsynchronised_images")),
      offset_alarms_(metrics.counter("sync.camera_offset_alarms")),
      offset_ms_(metrics.gauge("sync.camera_offset_ms")),
      offset_sigma_ms_(metrics.gauge("sync.camera_offset_sigma_ms")),
      points_(metrics.counter("keyframes.points")),
      keyframe_ms_(metrics.histogram("keyframe.group_ms")),
      latency_ms_(metrics.histogram("latency.group_to_pose_ms")),
      album_(kAlbumKeyframes),
      coloured_map_(kColouredMapSpacingM, kColouredMapPoints) {
  if (rig.camera && rig.imu && config.camera_offset.limit_s > 0.0)
    camera_offset_.emplace(config.camera_offset, *rig.camera);
}

bool KeyframeStage::in_sync(const TrackedFrame& frame) {
  if (!camera_offset_ || !frame.image || frame.group.health.state != tracking::TrackingState::kTracking)
    return true;
  const auto& points = frame.group.points_in_body;
  const std::size_t step = 1 + points.size() / kOffsetPoints;
  std::vector<Eigen::Vector3f> some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i].p_in_body_m);
  const std::uint64_t alarms = camera_offset_->alarms();
  camera_offset_->add(frame.group.stamp, frame.group.odom_from_body, some, *frame.image->image);
  const auto estimate = camera_offset_->estimate();
  if (estimate) {
    offset_ms_.set(1e3 * estimate->delay_s);
    offset_sigma_ms_.set(1e3 * estimate->sigma_s);
  }
  if (camera_offset_->alarms() > alarms) {
    offset_alarms_.add();
    EDGESPLAT_LOG_WARN("sync", "the camera's stamps are off: its pictures colour no points", "offset_ms",
                       estimate ? 1e3 * estimate->delay_s : 0.0);
  }
  if (!camera_offset_->in_sync()) out_of_sync_.add();
  return camera_offset_->in_sync();
}

Result<std::shared_ptr<const map::Keyframe>> KeyframeStage::make(const TrackedFrame& frame) {
  // A picture whose time is in doubt must not colour points: they wait for one whose is not.
  if (!in_sync(frame)) return builder_.add(frame.group, std::nullopt);
  const auto block = frame.image ? hold_out_.block_of(frame.group.stamp) : std::nullopt;
  if (!block) return builder_.add(frame.group, frame.image);
  EDGESPLAT_TRY(auto held_out, builder_.hold_out(frame.group, *frame.image));
  if (held_out) {
    held_out_.add();
    album_.add_held_out(std::move(held_out), *block);
  }
  return nullptr;
}

void KeyframeStage::operator()(const TrackedFrame& frame) {
  const HostTime start = work_clock_.now();
  auto made = make(frame);
  if (!made) {
    failed_.add();
    EDGESPLAT_LOG_WARN("keyframe", "not made", "why", made.error().context);
  } else if (*made) {
    made_.add();
    points_.add((*made)->points_in_body.size());
    coloured_map_.add(**made);
    album_.add(*made, frame.group.patches);
    sink_(*made);
  }
  const double keyframe_ms = to_seconds(work_clock_.now() - start) * 1e3;
  keyframe_ms_.record(keyframe_ms);
  latency_ms_.record(frame.latency_ms);
  log_.add(frame.group, frame.points_in_group, {frame.track_ms, keyframe_ms, frame.latency_ms});
}

}  // namespace edgesplat::app
