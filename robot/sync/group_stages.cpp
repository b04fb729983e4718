// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/group_stages.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

namespace edgesplat::sync {
namespace {

/// Before the first group nothing can be late.
constexpr HostTime kBeforeAll = HostTime::min();

}  // namespace

GroupBuilder::Stages::Stages(const GroupBuilderConfig& config, const sensor::Rig& rig)
    : config_(config),
      has_imu_(rig.imu.has_value()),
      has_camera_(rig.camera.has_value()),
      time_base_(config.clock, config.disagree_limit_s, config.imu_has_own_clock, rig.lidar_count()),
      imu_(config.max_imu_samples),
      images_(config.max_images, config.max_image_bytes),
      scans_(config.max_scans) {
  if (has_camera_) stamp_delay_ = from_seconds(rig.camera->stamp_delay_s);
  for (std::size_t unit = 0; unit < rig.lidar_count(); ++unit)
    lidars_.push_back({PointBuffer(config.max_points, static_cast<std::uint8_t>(unit)), {}, {}});
}

void GroupBuilder::Stages::take_in(sensor::Measurement& measurement) {
  std::visit([this](auto& one) { take_in(one); }, measurement);
}

void GroupBuilder::Stages::take_in(const sensor::ImuSample& sample) {
  if (!has_imu_ || !sample.gyro_radps.allFinite() || !sample.accel_mps2.allFinite()) {
    ++counters_.bad_values;
    return;
  }
  const HostTime t = time_base_.to_host(Stream::kImu, sample.stamp, sample.arrival, sample.stamp_source);
  if (!first_seen_) first_seen_ = t;
  imu_progress_.advance(t);
  const GroupImu taken{t, sample.gyro_radps, sample.accel_mps2};
  if (imu_listener_) imu_listener_(taken);
  imu_.push(taken, settled_.value_or(kBeforeAll), clamp_limit(Stream::kImu));
}

void GroupBuilder::Stages::take_in(sensor::LidarPacket& packet) {
  if (packet.unit >= lidars_.size()) {
    ++counters_.bad_values;
    return;
  }
  // A packet leaves the device after its last ray: that moment relates stamp and arrival.
  const HostTime last_ray = time_base_.to_host(points_of(packet.unit), packet.stamp + packet.span,
                                               packet.arrival, packet.stamp_source);
  if (!first_seen_) first_seen_ = last_ray - packet.span;
  Lidar& lidar = lidars_[packet.unit];
  lidar.progress.advance(last_ray);
  lidar.points.push(last_ray - packet.span, std::move(packet.points));
}

void GroupBuilder::Stages::take_in(sensor::LidarScan& scan) {
  whole_scans_ = true;
  // Whole scans come from recordings, whose stamps lie on one time line already.
  const HostTime start =
      time_base_.to_host(Stream::kPoints, scan.stamp, scan.arrival, sensor::StampSource::kPtp);
  if (!scans_.push(start, scan, settled_.value_or(kBeforeAll))) {
    ++counters_.late_scans;
    counters_.late_points += scan.points.size();
    return;
  }
  if (!first_seen_) first_seen_ = start;
  lidars_.front().progress.advance(start);
}

void GroupBuilder::Stages::take_in(const sensor::CameraFrame& frame) {
  if (!has_camera_ || frame.image == nullptr || frame.image->empty()) {
    ++counters_.bad_values;
    return;
  }
  const HostTime t =
      time_base_.to_host(Stream::kCamera, frame.stamp + stamp_delay_, frame.arrival, frame.stamp_source);
  if (!images_.push(t, frame)) ++counters_.late_images;
}

/// Refining a clock relation moves stamps by less than what would have been taken for a jump.
nanoseconds GroupBuilder::Stages::clamp_limit(Stream stream) const {
  return time_base_.is_exact(stream) ? nanoseconds(0) : from_seconds(config_.clock.jump_threshold_s);
}

std::vector<MeasureGroup> GroupBuilder::Stages::drain(bool all) {
  std::vector<MeasureGroup> groups;
  while (const auto end = scans_.earliest_end()) {
    if (!scan_is_ready(*end, all)) return groups;
    groups.push_back(make_scan_group(*end));
  }
  if (!whole_scans_)
    while (const auto cut = next_cut(all)) groups.push_back(make_group(*cut));
  if (all) counters_.unused_images += images_.drop_until(HostTime::max());
  return groups;
}

std::optional<HostTime> GroupBuilder::Stages::newest_data() const {
  std::optional<HostTime> newest = imu_progress_.newest;
  for (const Lidar& lidar : lidars_)
    if (lidar.progress.newest && (!newest || *lidar.progress.newest > *newest))
      newest = lidar.progress.newest;
  return newest;
}

std::optional<HostTime> GroupBuilder::Stages::earliest_point() const {
  std::optional<HostTime> earliest;
  for (const Lidar& lidar : lidars_)
    if (const auto first = lidar.points.earliest(); first && (!earliest || *first < *earliest))
      earliest = first;
  return earliest;
}

bool GroupBuilder::Stages::is_out(const Progress& stream) const {
  const auto newest = newest_data();
  return newest && *newest - stream.newest.value_or(*first_seen_) > from_seconds(config_.sensor_gap_s);
}

/// LiDARs and IMU are all newer than `t`, apart from those that fell silent.
bool GroupBuilder::Stages::sensors_reached(HostTime t) const {
  const auto newest = newest_data();
  if (!newest || *newest < t) return false;
  const bool lidars_ok = std::ranges::all_of(lidars_, [&](const Lidar& lidar) {
    return (lidar.progress.newest && *lidar.progress.newest > t) || is_out(lidar.progress);
  });
  const bool imu_ok =
      !has_imu_ || (imu_progress_.newest && *imu_progress_.newest >= t) || is_out(imu_progress_);
  return lidars_ok && imu_ok;
}

/// Once all sensors have begun (or are out), groups begin with the first point, or IMU sample.
bool GroupBuilder::Stages::decide_begin() {
  if (settled_) return true;
  if (!newest_data()) return false;
  const auto is_missed = [&](const Progress& stream) { return !stream.newest && !is_out(stream); };
  if (std::ranges::any_of(lidars_, [&](const Lidar& lidar) { return is_missed(lidar.progress); }))
    return false;
  if (has_imu_ && is_missed(imu_progress_)) return false;
  const auto first_point = earliest_point();
  const auto first_imu = imu_.first_after(kBeforeAll);
  if (!first_point && !first_imu) return false;
  settled_ = (first_point ? *first_point : *first_imu) - nanoseconds(1);
  return true;
}

/// After a pause of all sensors the next group begins with the first thing measured, not with empty groups.
void GroupBuilder::Stages::skip_silence() {
  std::optional<HostTime> first = earliest_point();
  const auto first_imu = imu_.first_after(*settled_);
  if (!first || (first_imu && *first_imu < *first)) first = first_imu;
  if (first && *first - *settled_ > 2 * from_seconds(config_.sensor_gap_s))
    settled_ = *first - nanoseconds(1);
}

std::optional<Cut> GroupBuilder::Stages::next_cut(bool all) {
  if (!decide_begin()) return std::nullopt;
  skip_silence();
  while (const auto image = images_.earliest()) {
    if (*image > *settled_) break;
    last_image_ = image;
    counters_.late_images += images_.drop_until(*image);
  }
  const auto end = next_end(all);
  if (!end || !(all || sensors_reached(*end))) return std::nullopt;
  return Cut{*settled_, *end};
}

/// Where the next group should end, if that can be known yet.
std::optional<HostTime> GroupBuilder::Stages::next_end(bool all) const {
  const auto newest = newest_data();
  if (!newest || *newest <= *settled_) return std::nullopt;
  const HostTime periodic = *settled_ + from_seconds(config_.period_s);
  if (has_camera_) {
    const nanoseconds gap = from_seconds(config_.image_gap_s);
    const HostTime previous = last_image_.value_or(*settled_);
    if (const auto image = images_.earliest(); image && (!all || *image <= *newest))
      return *image - previous <= gap ? *image : std::min(*image, periodic);
    // No image yet. It may be on its way, or the camera is out: then periodic cuts, late enough for an image
    // that lags to be still in time, so that the camera can come back.
    const nanoseconds wait = from_seconds(config_.image_wait_s);
    if (!all && (*newest - previous <= gap + wait || *newest < periodic + wait)) return std::nullopt;
  }
  return all ? std::min(periodic, *newest) : periodic;
}

MeasureGroup GroupBuilder::Stages::make_group(const Cut& cut) {
  MeasureGroup group;
  group.begin = cut.begin;
  group.end = cut.end;
  group.points = take_points(cut);
  group.imu = imu_.take(cut);
  if (images_.earliest() == cut.end) {
    group.image = images_.take_earliest();
    last_image_ = cut.end;
  }
  settled_ = cut.end;
  count_group(group);
  return group;
}

/// One scan of all LiDARs, oldest ray first.
std::vector<GroupPoint> GroupBuilder::Stages::take_points(const Cut& cut) {
  const auto older = [](const GroupPoint& a, const GroupPoint& b) {
    return a.before_end_ns > b.before_end_ns;
  };
  std::vector<GroupPoint> all;
  for (std::size_t unit = 0; unit < lidars_.size(); ++unit) {
    auto points = lidars_[unit].points.take(cut, clamp_limit(points_of(unit)));
    lidars_[unit].counters.points += points.size();
    if (all.empty()) {
      all = std::move(points);
      continue;
    }
    std::vector<GroupPoint> merged;
    merged.reserve(all.size() + points.size());
    std::merge(all.begin(), all.end(), points.begin(), points.end(), std::back_inserter(merged), older);
    all = std::move(merged);
  }
  return all;
}

/// A LiDAR of several that is not waited for any more, or again.
void GroupBuilder::Stages::note_outs() {
  for (Lidar& lidar : lidars_) {
    const bool out = is_out(lidar.progress);
    if (out && !lidar.counters.is_out) ++lidar.counters.outs;
    lidar.counters.is_out = out;
  }
}

/// Its image has come or cannot come any more, and the IMU is past its end.
bool GroupBuilder::Stages::scan_is_ready(HostTime end, bool all) const {
  if (all || scans_.crowded()) return true;
  if (has_imu_ && !(imu_progress_.newest && *imu_progress_.newest >= end) && !is_out(imu_progress_))
    return false;
  if (!has_camera_) return true;
  const nanoseconds patience = from_seconds(config_.image_wait_s) + from_seconds(config_.image_tolerance_s);
  return (images_.newest_seen() && *images_.newest_seen() >= end) || *newest_data() - end > patience;
}

MeasureGroup GroupBuilder::Stages::make_scan_group(HostTime end) {
  MeasureGroup group;
  scans_.take_earliest(group);
  group.begin = settled_.value_or(end - from_seconds(config_.period_s));
  group.imu = imu_.take({group.begin, end});
  group.image = images_.take_nearest(end, from_seconds(config_.image_tolerance_s));
  counters_.unused_images += images_.drop_until(end);
  settled_ = end;
  count_group(group);
  return group;
}

void GroupBuilder::Stages::count_group(const MeasureGroup& group) {
  ++counters_.groups;
  if (!whole_scans_) note_outs();
  if (has_camera_ && !group.image) ++counters_.groups_without_image;
  if (group.points.empty()) ++counters_.groups_without_points;
  if (has_imu_ && (group.imu.empty() || group.imu.back().stamp < group.end)) ++counters_.groups_without_imu;
}

GroupCounters GroupBuilder::Stages::counters() const {
  GroupCounters all = counters_;
  for (const Lidar& lidar : lidars_) {
    all.late_points += lidar.points.late();
    all.clamped_points += lidar.points.clamped();
    all.overflow_points += lidar.points.overflow();
    all.lidars.push_back(lidar.counters);
  }
  all.late_imu = imu_.late();
  all.overflow_imu = imu_.overflow();
  all.overflow_images = images_.overflow();
  all.clock_changes = time_base_.clock_changes();
  all.clock_lies = time_base_.lies();
  return all;
}

}  // namespace edgesplat::sync
