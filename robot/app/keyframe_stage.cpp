// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/keyframe_stage.hpp"

#include "common/log/log.hpp"

namespace edgesplat::app {
namespace {

constexpr std::size_t kAlbumKeyframes = 24;
constexpr double kColouredMapSpacingM = 0.04;
constexpr std::size_t kColouredMapPoints = 4'000'000;  // 64 MB

}  // namespace

KeyframeStage::KeyframeStage(const keyframe::KeyframeConfig& config, const sensor::Rig& rig,
                             KeyframeSink sink, const Clock& work_clock, metrics::Registry& metrics)
    : builder_(config, rig),
      hold_out_(config),
      sink_(std::move(sink)),
      work_clock_(work_clock),
      made_(metrics.counter("keyframes.made")),
      held_out_(metrics.counter("keyframes.held_out")),
      failed_(metrics.counter("keyframes.failed")),
      points_(metrics.counter("keyframes.points")),
      keyframe_ms_(metrics.histogram("keyframe.group_ms")),
      latency_ms_(metrics.histogram("latency.group_to_pose_ms")),
      album_(kAlbumKeyframes),
      coloured_map_(kColouredMapSpacingM, kColouredMapPoints) {}

Result<std::shared_ptr<const map::Keyframe>> KeyframeStage::make(const TrackedFrame& frame) {
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
    album_.add(*made);
    sink_(*made);
  }
  const double keyframe_ms = to_seconds(work_clock_.now() - start) * 1e3;
  keyframe_ms_.record(keyframe_ms);
  latency_ms_.record(frame.latency_ms);
  log_.add(frame.group, frame.points_in_group, {frame.track_ms, keyframe_ms, frame.latency_ms});
}

}  // namespace edgesplat::app
