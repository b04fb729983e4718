// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/metrics/registry.hpp"
#include "common/time/clock.hpp"
#include "robot/app/live_map.hpp"
#include "robot/render/view.hpp"
#include "robot/tracking/gaussian_view.hpp"

namespace edgesplat::app {

/// The live map for tracking to look at: draws its newest snapshot, on the GPU where there is one. Waits for
/// nothing. Belongs to the tracking thread. Histogram tracking.map_draw_ms.
class MapLook : public tracking::GaussianView {
 public:
  /// All must outlive it.
  MapLook(const LiveMap& map, const Clock& clock, metrics::Registry& metrics)
      : map_(map), clock_(clock), draw_ms_(metrics.histogram("tracking.map_draw_ms")) {}

  [[nodiscard]] std::optional<tracking::GaussianPicture> draw(
      const geometry::CameraModel& camera, const geometry::RigidTransform& odom_from_camera) override;

 private:
  const LiveMap& map_;
  const Clock& clock_;
  metrics::Histogram& draw_ms_;
  render::ViewDrawer drawer_;
};

}  // namespace edgesplat::app
