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
      sink_(std::move(sink)),
      work_clock_(work_clock),
      made_(metrics.counter("keyframes.made")),
      failed_(metrics.counter("keyframes.failed")),
      points_(metrics.counter("keyframes.points")),
      keyframe_ms_(metrics.histogram("keyframe.group_ms")),
      latency_ms_(metrics.histogram("latency.group_to_pose_ms")),
      album_(kAlbumKeyframes),
      coloured_map_(kColouredMapSpacingM, kColouredMapPoints) {}

void KeyframeStage::operator()(const TrackedFrame& frame) {
  const HostTime start = work_clock_.now();
  auto made = builder_.add(frame.group, frame.image);
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
