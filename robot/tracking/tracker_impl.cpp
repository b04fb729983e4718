// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/tracker_impl.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace edgesplat::tracking {
namespace {

/// A rig whose IMU is silent for this many groups starts without it.
constexpr int kGroupsUntilFree = 10;
/// Corrections of the motion within a group larger than these deskew the points anew.
constexpr double kDeskewAgain_m = 0.002;
constexpr double kDeskewAgain_rad = 0.0005;
/// A body that seems to stand still moves no faster than this in any direction that is seen, and is then
/// taken to be no faster in the others.
constexpr double kRestSpeed_mps = 0.05;
constexpr double kRestSigma_mps = 0.02;

ScanUpdateConfig update_config(const TrackingConfig& config) {
  return {config.max_iterations, static_cast<float>(config.gate_sigma),
          static_cast<float>(config.min_residual_sigma_m), config.min_residuals};
}

}  // namespace

PlaneMapConfig map_config(const TrackingConfig& config) {
  return {config.root_voxel_m,
          config.max_layer,
          static_cast<float>(config.plane_sigma_max_m),
          static_cast<std::uint32_t>(config.plane_min_points),
          static_cast<std::uint32_t>(config.plane_freeze_points),
          config.map_half_extent_m,
          static_cast<std::size_t>(config.map_max_mb) << 20U};
}

Tracker::Impl::Impl(const TrackingConfig& config_in, const sensor::Rig& rig_in, Gravity gravity_in)
    : config(config_in),
      rig(rig_in),
      gravity(gravity_in),
      loop(config_in.threads),
      map(map_config(config_in)),
      updater(update_config(config_in), loop),
      sweep(rig_in, config_in.max_range_m, loop),
      free_motion(config_in),
      initialiser(config_in, rig_in.imu.value_or(sensor::ImuModel{})),
      rest(rig_in.imu.value_or(sensor::ImuModel{})),
      watch(calibration_config(config_in, rig_in)),
      with_imu(rig_in.imu.has_value()) {
  if (config.visual && rig.camera) visual.emplace(config, *rig.camera, largest_noise(rig), loop);
  for (std::size_t unit = 0; unit < rig.lidar_count(); ++unit) beams.push_back(beam_of(rig.mount_of(unit)));
  if (with_imu && gravity == Gravity::kFelt) moving_start = std::make_unique<MovingStart>(config, rig);
  if (config.gaussian_every > 0 && rig.camera)
    gaussian_updater.emplace(gaussian_config(config), *rig.camera, loop);
}
Tracker::Impl::~Impl() = default;

Status Tracker::Impl::check_times(const sync::MeasureGroup& group) const {
  if (group.end < group.begin) {
    return fail(Errc::kInvalidArgument, fmt::format("group ends at {} ns, before it begins at {} ns: skip it",
                                                    to_ns(group.end), to_ns(group.begin)));
  }
  if (last_end && group.end <= *last_end) {
    return fail(
        Errc::kInvalidArgument,
        fmt::format("group ends at {} ns, not after the one before ({} ns): groups must come in order",
                    to_ns(group.end), to_ns(*last_end)));
  }
  return {};
}

void Tracker::Impl::clean_imu(const sync::MeasureGroup& group) {
  std::vector<sync::GroupImu> good;
  for (const sync::GroupImu& sample : group.imu) {
    const bool finite = sample.gyro_radps.allFinite() && sample.accel_mps2.allFinite();
    if (finite && (good.empty() || sample.stamp > good.back().stamp)) {
      good.push_back(sample);
    } else {
      ++counters.bad_imu_samples;
    }
  }
  if (!good.empty()) {
    imu = std::move(good);
  } else if (imu.size() > 1) {
    imu.erase(imu.begin(), imu.end() - 1);
  }
}

void Tracker::Impl::initialise(const sync::MeasureGroup& group) {
  if (with_imu) {
    groups_without_imu = group.imu.empty() ? groups_without_imu + 1 : 0;
    with_imu = groups_without_imu < kGroupsUntilFree;
  }
  if (!with_imu) {
    belief = free_motion.first_belief();
  } else if (gravity == Gravity::kNone) {
    belief = free_motion.first_belief();
    belief->covariance.block<3, 3>(kGyroBias, kGyroBias) =
        config.init_gyro_rate_max_radps * config.init_gyro_rate_max_radps * Eigen::Matrix3d::Identity();
  } else {
    initialise_with_imu(group);
  }
}

void Tracker::Impl::initialise_with_imu(const sync::MeasureGroup& group) {
  started = moving_start->add(group, imu);
  belief = initialiser.add(imu);
  if (!moving_start->sees_rest()) belief.reset();  // smooth driving feels like rest
  if (!belief) {
    if (!started) return;
    belief = started->belief;
    ++counters.moving_starts;
  } else {
    started.reset();
  }
  counters.refused_starts = moving_start->refused();
  moving_start.reset();
}

std::int64_t Tracker::Impl::refused_starts() const {
  return moving_start ? moving_start->refused() : counters.refused_starts;
}

// Without an IMU the pose is estimated for the middle of the points' times: an error of the estimated rate
// then distorts the points evenly to both sides and moves the pose little. Estimated for the end, it moves
// the pose the other way, the next rate swings back too far, and the two build up (seen in turns of 0.8
// rad/s).
HostTime Tracker::Impl::update_time(const sync::MeasureGroup& group) const {
  return with_imu ? group.end : std::max(sweep.middle(), belief_time + (group.end - belief_time) / 4);
}

Prediction Tracker::Impl::predict(const sync::MeasureGroup& group) {
  const Interval interval{belief_time, update_time(group)};
  if (!with_imu) {
    Prediction prediction = predict_without_imu(*belief, free_motion.without_imu(), interval);
    prediction.path = uniform_path(prediction.belief.state, interval.end, {group.begin, group.end});
    return prediction;
  }
  Prediction prediction;
  if (imu.empty()) {
    prediction = predict_without_imu(*belief, free_motion.in_a_hole(), interval);
    prediction.imu_covers = false;
  } else {
    prediction = predict_with_imu(*belief, imu, *rig.imu, free_motion.in_a_hole(), interval);
  }
  if (!prediction.imu_covers) ++counters.imu_gaps;
  return prediction;
}

void Tracker::Impl::pick_scan_points() {
  const auto points = sweep.points_in_body_m();
  const auto kept = sweep.thinned(config.scan_voxel_m);
  const auto wanted = static_cast<std::size_t>(config.max_scan_points);
  const std::size_t count = std::min(kept.size(), wanted);
  scan_points_m.clear();
  scan_units.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t point = kept[i * kept.size() / count];
    scan_points_m.push_back(points[point]);
    scan_units.push_back(sweep.units()[point]);
  }
}

ScanView Tracker::Impl::scan_view() const {
  return {scan_points_m, beams, scan_units, estimates_calibration ? &scan_calibration : nullptr};
}

ScanUpdateResult Tracker::Impl::match(const Prediction& prediction, const FilterState& start) {
  sweep.deskew(prediction.path, start.odom_from_body.inverse(), start.calibration);
  pick_scan_points();
  deskewed_with = start.calibration;
  return updater.run(prediction.belief, start, scan_view(), map);
}

ScanUpdateResult Tracker::Impl::update(Prediction& prediction, HostTime at) {
  const FilterState& predicted = prediction.belief.state;
  ScanUpdateResult result = match(prediction, predicted);
  if (!result.updated || !sweep.has_point_times() || prediction.path.size() < 2) return result;
  const double span_s = to_seconds(prediction.path.back().stamp - prediction.path.front().stamp);
  const ErrorVector correction = minus(result.belief.state, predicted);
  const Vector6d recalibrated =
      scan_calibration.by_calibration * minus(result.belief.state.calibration, predicted.calibration);
  if (correction.segment<3>(kVel).norm() * span_s < kDeskewAgain_m &&
      correction.segment<3>(kGyroBias).norm() * span_s < kDeskewAgain_rad &&
      recalibrated.tail<3>().norm() < kDeskewAgain_m && recalibrated.head<3>().norm() < kDeskewAgain_rad) {
    return result;
  }
  correct_path(prediction.path, at, predicted, result.belief.state);
  if (scans_to_redraw == kRedrawnScans) {
    // The map is the first scan, as little deskewed as this one was: only like that do they match. The map is
    // now drawn from this scan, deskewed.
    sweep.deskew(prediction.path, result.belief.state.odom_from_body.inverse(),
                 result.belief.state.calibration);
    return result;
  }
  ScanUpdateResult again = match(prediction, result.belief.state);
  return again.updated ? again : result;
}

void Tracker::Impl::use_rest(const ScanUpdateResult& result) {
  if (!with_imu || gravity == Gravity::kNone || imu.empty() || !rest.add(imu, belief->state)) return;
  const Eigen::Matrix3d unseen =
      result.updated ? result.observed.frozen_steps : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  if (seen_velocity_mps(belief->state, unseen).norm() < kRestSpeed_mps)
    hold_velocity(*belief, unseen, kRestSigma_mps);
}

TrackedGroup Tracker::Impl::report(const sync::MeasureGroup& group, const ScanUpdateResult& result,
                                   const VisualUpdateResult& picture,
                                   const GaussianUpdateResult& gaussians) const {
  const FilterBelief at_end =
      belief_time < group.end
          ? predict_without_imu(*belief, free_motion.without_imu(), {belief_time, group.end}).belief
          : *belief;
  TrackedGroup tracked;
  tracked.stamp = group.end;
  tracked.odom_from_body = at_end.state.odom_from_body;
  if (const CalibrationView* calibration = picture_calibration()) {
    tracked.stamp += from_seconds(at_end.state.calibration.camera_delay_s);
    tracked.odom_from_body = odom_from_body_of_picture(at_end.state, calibration);
  }
  tracked.pose_covariance = at_end.covariance.topLeftCorner<6, 6>();
  tracked.velocity_in_odom_mps = at_end.state.velocity_in_odom_mps;
  tracked.gravity_in_odom_mps2 = at_end.state.gravity_in_odom_mps2;
  if (with_imu) {
    tracked.gyro_bias_radps = belief->state.gyro_bias_radps;
    tracked.accel_bias_mps2 = belief->state.accel_bias_mps2;
  }
  tracked.health.state = state;
  tracked.health.points_used = result.last.used;
  tracked.health.iterations = result.iterations;
  tracked.health.frozen_directions = result.observed.frozen;
  tracked.health.weakest = result.observed.weakest;
  tracked.health.visual_patches = picture.patches;
  tracked.health.visual_noise_scale = picture.noise_scale;
  tracked.health.log_gain = belief->state.log_gain;
  tracked.health.gaussian = gaussians.verdict;
  tracked.health.gaussian_explained = gaussians.explained;
  tracked.health.gaussian_chi_squared = gaussians.chi_squared;
  tracked.health.offsets = watch.report(*belief, rig.body_from_lidar);
  if (result.last.used > 0)
    tracked.health.residual_rms_m = std::sqrt(result.last.squares_m2 / result.last.used);
  tracked.health.translation_conditioning = result.translation_conditioning;
  tracked.patches = patches;
  tracked.points_in_body = sweep.deskewed(tracked.odom_from_body.inverse() * belief->state.odom_from_body);
  return tracked;
}

TrackedGroup Tracker::Impl::start(const sync::MeasureGroup& group) {
  initialise(group);
  last_end = group.end;
  belief_time = with_imu ? group.end : sweep.middle();
  TrackedGroup waiting;
  waiting.stamp = group.end;
  if (!belief) return waiting;
  watch.begin(*belief, rig.body_from_lidar, with_imu);
  estimates_calibration = with_imu && watch.estimates();
  if (started) return start_in_motion(group);
  std::vector<PathKnot> path = {{group.end, belief->state.odom_from_body}};
  // The speed is unknown, but the gyro tells how the body turned.
  if (with_imu)
    path = predict_with_imu(*belief, imu, *rig.imu, free_motion.in_a_hole(), {group.begin, group.end}).path;
  sweep.deskew(path, path.back().odom_from_body.inverse(), belief->state.calibration);
  ScanUpdateResult first;
  first.updated = true;  // this pose defines odom
  extend_map(first);
  scans_to_redraw = kRedrawnScans;
  state = TrackingState::kTracking;
  TrackedGroup tracked = report(group, first, {}, {});
  // Without an IMU the speed is unknown until the second group: a sweep cannot be deskewed yet, and where the
  // body was at its end is not known either. The map is begun, but no pose is claimed.
  if (!with_imu && sweep.has_point_times()) tracked.health.state = TrackingState::kInitialising;
  return tracked;
}

TrackedGroup Tracker::Impl::start_in_motion(const sync::MeasureGroup& group) {
  for (const EarlyScan& scan : started->scans) {
    std::vector<std::uint32_t> all(scan.points_in_body_m.size());
    std::iota(all.begin(), all.end(), 0U);
    insert_points(scan.points_in_body_m, scan.units, all, scan.odom_from_body, scan.pose_covariance);
  }
  sweep.deskew(started->path, belief->state.odom_from_body.inverse(), belief->state.calibration);
  started.reset();
  ScanUpdateResult found;
  found.updated = true;  // the pose is that of the odometry that found it
  extend_map(found);
  state = TrackingState::kTracking;
  return report(group, found, {}, {});
}

Result<TrackedGroup> Tracker::Impl::track(const sync::MeasureGroup& group) {
  EDGESPLAT_TRY_STATUS(check_times(group));
  ++counters.groups;
  clean_imu(group);
  sweep.load(group, counters);
  if (!belief) return start(group);
  Prediction prediction = predict(group);
  const HostTime at = update_time(group);
  watch_calibration(group, prediction);
  ScanUpdateResult result = update(prediction, at);
  check(result, prediction);
  if (!result.updated) ++counters.coasted_groups;
  if (result.updated && !with_imu) {
    free_motion.observe(minus(result.belief.state, prediction.belief.state), to_seconds(at - belief_time));
  }
  belief = result.belief;
  belief_time = at;
  unseen_steps = result.observed.frozen_steps;
  last_end = group.end;
  const VisualUpdateResult picture = see(group);
  const GaussianUpdateResult gaussians = look_at_gaussians(group, result);
  if (!picture.updated) use_rest(result);
  judge(result, picture, to_seconds(group.end - group.begin));
  extend_map(result);
  if (picture_taken && !keeper.lost()) visual->extend(*belief, map, picture_calibration());
  return report(group, result, picture, gaussians);
}

}  // namespace edgesplat::tracking
