// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/sensing_chain.hpp"

#include "common/log/log.hpp"

#include <string>
#include <utility>

namespace edgesplat::app {
namespace {

/// "points" of the first LiDAR, "points_1" of the second, ...
std::string points_name(std::size_t unit) {
  return unit == 0 ? "points" : "points_" + std::to_string(unit);
}

void publish_clocks(const sync::GroupBuilder& builder, std::size_t lidars, metrics::Registry& metrics) {
  std::vector<std::pair<std::string, sync::Stream>> streams{{"imu", sync::Stream::kImu},
                                                            {"camera", sync::Stream::kCamera}};
  for (std::size_t unit = 0; unit < lidars; ++unit)
    streams.emplace_back(points_name(unit), sync::points_of(unit));
  for (const auto& [name, stream] : streams) {
    const auto clock = builder.clock_state(stream);
    if (!clock) continue;
    const std::string prefix = "sync." + name;
    metrics.gauge(prefix + ".disciplined").set(clock->exact ? 1.0 : 0.0);
    metrics.gauge(prefix + ".offset_s").set(clock->offset_s);
    metrics.gauge(prefix + ".drift_ppm").set(clock->drift_ppm);
    metrics.gauge(prefix + ".jitter_us").set(1e6 * clock->jitter_s);
  }
}

void publish_lidars(const std::vector<sync::LidarCounters>& lidars, metrics::Registry& metrics) {
  for (std::size_t unit = 0; unit < lidars.size(); ++unit) {
    metrics.counter("sync." + points_name(unit) + ".in_groups").add(lidars[unit].points);
    metrics.counter("sync." + points_name(unit) + ".outs").add(lidars[unit].outs);
  }
}

void publish_offsets(const tracking::SensorOffsets& offsets, metrics::Registry& metrics) {
  const std::pair<const char*, double> found[] = {
      {"lidar_delay_ms", 1e3 * offsets.lidar_delay_s},
      {"lidar_delay_sigma_ms", 1e3 * offsets.lidar_delay_sigma_s},
      {"lidar_delay_frozen", offsets.lidar_delay_frozen ? 1.0 : 0.0},
      {"camera_delay_ms", 1e3 * offsets.camera_delay_s},
      {"camera_delay_sigma_ms", 1e3 * offsets.camera_delay_sigma_s},
      {"camera_delay_frozen", offsets.camera_delay_frozen ? 1.0 : 0.0},
      {"lidar_turn_x_mrad", 1e3 * offsets.lidar_turn_rad.x()},
      {"lidar_turn_y_mrad", 1e3 * offsets.lidar_turn_rad.y()},
      {"lidar_turn_z_mrad", 1e3 * offsets.lidar_turn_rad.z()},
      {"lidar_turn_sigma_mrad", 1e3 * offsets.lidar_turn_sigma_rad},
      {"lidar_turn_frozen", static_cast<double>(offsets.frozen_turns)},
      {"lidar_step_x_mm", 1e3 * offsets.lidar_step_m.x()},
      {"lidar_step_y_mm", 1e3 * offsets.lidar_step_m.y()},
      {"lidar_step_z_mm", 1e3 * offsets.lidar_step_m.z()},
      {"lidar_step_sigma_mm", 1e3 * offsets.lidar_step_sigma_m},
      {"lidar_step_frozen", static_cast<double>(offsets.frozen_steps)},
  };
  for (const auto& [name, value] : found) metrics.gauge(std::string("tracking.") + name).set(value);
}

sync::GroupBuilderConfig with_clocks(const robot_config::RobotConfig& config) {
  sync::GroupBuilderConfig sync = config.sync;
  sync.imu_has_own_clock = config.serial.imu;
  return sync;
}

std::vector<ReadyGroup> stamp_groups(std::vector<sync::MeasureGroup> groups, HostTime now) {
  std::vector<ReadyGroup> ready;
  ready.reserve(groups.size());
  for (sync::MeasureGroup& group : groups) ready.push_back({std::move(group), now});
  return ready;
}

}  // namespace

Result<std::unique_ptr<SensingChain>> SensingChain::create(const robot_config::RobotConfig& config,
                                                           const sensor::Rig& rig,
                                                           KeyframeStage::KeyframeSink sink,
                                                           const Clock& work_clock,
                                                           metrics::Registry& metrics) {
  EDGESPLAT_TRY(auto tracker, tracking::Tracker::create(config.tracking, rig));
  return std::unique_ptr<SensingChain>(
      new SensingChain(config, rig, std::move(tracker), std::move(sink), work_clock, metrics));
}

SensingChain::SensingChain(const robot_config::RobotConfig& config, const sensor::Rig& rig,
                           std::unique_ptr<tracking::Tracker> tracker, KeyframeStage::KeyframeSink sink,
                           const Clock& work_clock, metrics::Registry& metrics)
    : work_clock_(work_clock),
      group_builder_(with_clocks(config), rig),
      tracker_(std::move(tracker)),
      keyframe_stage_(config, rig, std::move(sink), work_clock, metrics),
      track_ms_(metrics.histogram("tracking.group_ms")),
      refused_groups_(metrics.counter("tracking.refused_groups")),
      streamed_poses_(metrics.counter("pose_stream.poses")) {
  group_builder_.on_imu([this](const sync::GroupImu& sample) { stream_pose(sample); });
}

std::vector<ReadyGroup> SensingChain::sync(sensor::Measurement measurement) {
  if (const auto* sample = std::get_if<sensor::ImuSample>(&measurement)) sample_arrival_ = sample->arrival;
  auto groups = group_builder_.push(std::move(measurement));
  if (!groups.empty()) watch_clocks();
  return stamp_groups(std::move(groups), work_clock_.now());
}

void SensingChain::stream_pose(const sync::GroupImu& sample) {
  const auto pose = pose_stream_.on_sample(sample);
  if (!pose) return;
  streamed_poses_.add();
  if (pose_sink_) pose_sink_(*pose, sample_arrival_);
}

/// One line for each clock that turned out wrong.
void SensingChain::watch_clocks() {
  const sync::GroupCounters counters = group_builder_.counters();
  if (counters.clock_lies > clock_lies_) {
    EDGESPLAT_LOG_WARN("sync",
                       "a clock that says it is disciplined is not: its stamps are fitted from now on",
                       "lies", counters.clock_lies);
  }
  clock_lies_ = counters.clock_lies;
}

std::vector<ReadyGroup> SensingChain::flush() {
  return stamp_groups(group_builder_.flush(), work_clock_.now());
}

std::optional<TrackedFrame> SensingChain::track(ReadyGroup ready) {
  const HostTime start = work_clock_.now();
  auto tracked = tracker_->track(ready.group);
  const HostTime end = work_clock_.now();
  if (!tracked) {
    refused_groups_.add();
    EDGESPLAT_LOG_WARN("tracking", "group refused", "why", tracked.error().context);
    return std::nullopt;
  }
  pose_stream_.correct(*tracked);
  offsets_ = tracked->health.offsets;
  TrackedFrame frame;
  frame.group = std::move(*tracked);
  frame.image = std::move(ready.group.image);
  frame.points_in_group = static_cast<int>(ready.group.points.size());
  frame.track_ms = to_seconds(end - start) * 1e3;
  frame.latency_ms = to_seconds(end - ready.ready) * 1e3;
  track_ms_.record(frame.track_ms);
  return frame;
}

void SensingChain::publish_counters(metrics::Registry& metrics) const {
  const sync::GroupCounters s = group_builder_.counters();
  const std::pair<const char*, std::uint64_t> counted[] = {
      {"sync.groups", s.groups},
      {"sync.groups_without_image", s.groups_without_image},
      {"sync.groups_without_points", s.groups_without_points},
      {"sync.groups_without_imu", s.groups_without_imu},
      {"sync.late_points", s.late_points},
      {"sync.clamped_points", s.clamped_points},
      {"sync.overflow_points", s.overflow_points},
      {"sync.late_imu", s.late_imu},
      {"sync.overflow_imu", s.overflow_imu},
      {"sync.late_images", s.late_images},
      {"sync.overflow_images", s.overflow_images},
      {"sync.unused_images", s.unused_images},
      {"sync.late_scans", s.late_scans},
      {"sync.bad_values", s.bad_values},
      {"sync.clock_changes", s.clock_changes},
      {"sync.clock_lies", s.clock_lies},
  };
  for (const auto& [name, value] : counted) metrics.counter(name).add(value);
  publish_clocks(group_builder_, s.lidars.size(), metrics);
  publish_lidars(s.lidars, metrics);
  const tracking::TrackingCounters t = tracker_->counters();
  const std::pair<const char*, std::int64_t> tracked[] = {
      {"tracking.groups", t.groups},
      {"tracking.coasted_groups", t.coasted_groups},
      {"tracking.bad_points", t.bad_points},
      {"tracking.out_of_range_points", t.out_of_range_points},
      {"tracking.bad_imu_samples", t.bad_imu_samples},
      {"tracking.imu_gaps", t.imu_gaps},
      {"tracking.moving_starts", t.moving_starts},
      {"tracking.refused_starts", t.refused_starts},
      {"tracking.evicted_cells", t.evicted_cells},
      {"tracking.unused_pictures", t.unused_pictures},
      {"tracking.visual_updates", t.visual_updates},
      {"tracking.gaussian_looks", t.gaussian_looks},
      {"tracking.gaussian_updates", t.gaussian_updates},
  };
  for (const auto& [name, value] : tracked) metrics.counter(name).add(static_cast<std::uint64_t>(value));
  publish_offsets(offsets_, metrics);
  metrics.gauge("tracking.map_bytes").set(static_cast<double>(t.map_bytes));
  metrics.gauge("tracking.visual_points").set(static_cast<double>(t.visual_points));
  metrics.gauge("tracking.visual_map_bytes").set(static_cast<double>(t.visual_map_bytes));
  metrics.gauge("tracking.span_s").set(keyframe_stage_.log().span_s());
  metrics.gauge("tracking.sum_ms").set(keyframe_stage_.log().track_sum_ms());
  metrics.gauge("tracking.poses").set(static_cast<double>(keyframe_stage_.log().poses()));
  metrics.gauge("map.coloured_points")
      .set(static_cast<double>(keyframe_stage_.coloured_map().points().size()));
}

}  // namespace edgesplat::app
