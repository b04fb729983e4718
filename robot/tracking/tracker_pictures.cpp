// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The camera's part of Tracker::Impl: patches, and the Gaussian map.
#include "robot/tracking/tracker_impl.hpp"

namespace edgesplat::tracking {

GaussianUpdateConfig gaussian_config(const TrackingConfig& config) {
  GaussianUpdateConfig gaussian;
  gaussian.width_px = config.gaussian_width_px;
  gaussian.depth = config.gaussian_depth;
  return gaussian;
}

// Without an IMU the pose is that of the middle of the points' times, not the picture's.
VisualUpdateResult Tracker::Impl::see(const sync::MeasureGroup& group) {
  picture_taken = false;
  patches.clear();
  if (!visual || !group.image || !group.image->image || !with_imu) return {};
  picture_taken = visual->take(*group.image);
  if (!picture_taken) {
    ++counters.unused_pictures;
    return {};
  }
  VisualUpdateResult result = visual->update(*belief, sweep.points_in_body_m(), picture_calibration());
  if (!result.updated) return result;
  ++counters.visual_updates;
  patches = visual->tracked_patches(picture_calibration());
  belief = result.belief;
  return result;
}

GaussianUpdateResult Tracker::Impl::look_at_gaussians(const sync::MeasureGroup& group,
                                                      const ScanUpdateResult& scan) {
  const bool can_look = gaussian_updater && gaussian_view && with_imu && group.image && group.image->image;
  if (!can_look || keeper.lost() || ++pictures_since_look < config.gaussian_every) return {};
  pictures_since_look = 0;
  ++counters.gaussian_looks;
  const bool alone = !scan.updated || scan.observed.frozen > 0;
  GaussianUpdateResult result =
      gaussian_updater->run(*belief, *group.image->image, sweep.points_in_body_m(), *gaussian_view, alone);
  if (!result.updated()) return result;
  ++counters.gaussian_updates;
  belief = result.belief;
  return result;
}

}  // namespace edgesplat::tracking
