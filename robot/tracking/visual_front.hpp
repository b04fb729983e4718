// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/tracking/plane_map.hpp"
#include "robot/tracking/tracked_group.hpp"
#include "robot/tracking/tracking_config.hpp"
#include "robot/tracking/visual_growth.hpp"
#include "robot/tracking/visual_update.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::tracking {

/// The camera's part of tracking: for each picture first update(), then extend(). Thread-bound.
class VisualFront {
 public:
  /// `scan_noise` of the points that update() gets.
  VisualFront(const TrackingConfig& config, const sensor::CameraMount& camera, const PointNoise& scan_noise,
              BlockLoop& loop);

  /// Whether a picture can be used: the camera's size, and something to be seen on it.
  [[nodiscard]] bool take(const sync::GroupImage& picture);
  /// Aligns the picture taken with the map. `points` are the scan's, in the body at the picture's moment.
  /// `calibration`: how the camera's delay shows; null where there is none.
  VisualUpdateResult update(const FilterBelief& prior, std::span<const Eigen::Vector3f> points_in_body_m,
                            const CalibrationView* calibration = nullptr);
  /// Where the patches of the last update lie in the picture, and how well each fits.
  [[nodiscard]] std::vector<TrackedPatch> tracked_patches(const CalibrationView* calibration = nullptr) const;
  /// Adds what the picture shows, with the pose as it is now known.
  void extend(const FilterBelief& belief, const PlaneMap& planes,
              const CalibrationView* calibration = nullptr);

  [[nodiscard]] const VisualMap& map() const { return map_; }

 private:
  /// The prior with what is known of the picture's gain before looking at it.
  [[nodiscard]] FilterBelief with_gain(const FilterBelief& prior) const;

  TrackingConfig config_;
  geometry::CameraModel full_;
  geometry::CameraModel camera_;  ///< of the pyramid's level 0
  geometry::RigidTransform body_from_camera_;
  int skip_;  ///< halvings from the picture to level 0
  PictureGrid grid_;
  VisualUpdater updater_;
  VisualMap map_;
  image::GrayPyramid pyramid_;
  DepthCells depths_;
  std::vector<SelectedPatch> patches_;
  VisualUpdateResult last_;
  std::uint32_t pictures_ = 0;
  std::optional<double> exposure_log_gain_;  ///< what the present picture's exposure alone would make it
  std::optional<double> first_exposure_log_gain_;  ///< the first picture's, where its log gain is 0
};

}  // namespace edgesplat::tracking
