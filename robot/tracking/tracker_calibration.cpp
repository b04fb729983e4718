// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The part of Tracker::Impl that judges what of the sensors' delays and mounting shows.
#include "robot/tracking/tracker_impl.hpp"

namespace edgesplat::tracking {
namespace {

/// A picture's delay is turned into motion by that of so long before it.
constexpr auto kPictureTwist = std::chrono::milliseconds(20);

}  // namespace

TrackingConfig calibration_config(const TrackingConfig& config, const sensor::Rig& rig) {
  TrackingConfig estimated = config;
  if (!config.visual || !rig.camera) estimated.camera_delay_sigma_s = 0.0;
  return estimated;
}

void Tracker::Impl::watch_calibration(const sync::MeasureGroup& group, Prediction& prediction) {
  camera_calibration.twist = twist_at_end(prediction.path, kPictureTwist);
  if (!estimates_calibration) return;
  watch.drift(prediction.belief, to_seconds(group.end - belief_time));
  const FilterState& predicted = prediction.belief.state;
  scan_calibration.twist = twist_at_end(prediction.path, group.end - group.begin);
  watch.add(group.end, predicted, scan_calibration.twist, camera_calibration.twist);
  scan_calibration.by_calibration = scan_by_calibration(predicted, scan_calibration.twist);
  camera_calibration.by_calibration = picture_by_calibration(camera_calibration.twist);
  const PoseByCalibration mean = watch.mean_at(predicted.odom_from_body);
  camera_calibration.mean_by_calibration.col(kCameraDelay) = mean.col(kCameraDelay);
  scan_calibration.mean_by_calibration = mean;
  scan_calibration.mean_by_calibration.col(kCameraDelay).setZero();
  scan_calibration.frozen = camera_calibration.frozen = watch.frozen();
}

const CalibrationView* Tracker::Impl::picture_calibration() const {
  const bool is_exact = config.camera_delay_s == 0.0 && config.camera_delay_sigma_s == 0.0;
  return with_imu && visual && !(is_exact && !estimates_calibration) ? &camera_calibration : nullptr;
}

}  // namespace edgesplat::tracking
