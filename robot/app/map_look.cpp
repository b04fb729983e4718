// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/map_look.hpp"

#include "common/log/log.hpp"

#include <utility>

namespace edgesplat::app {

std::optional<tracking::GaussianPicture> MapLook::draw(const geometry::CameraModel& camera,
                                                       const geometry::RigidTransform& odom_from_camera) {
  const auto placed = map_.placed();
  if (placed.in_map->size() == 0) return std::nullopt;
  const HostTime began = clock_.now();
  auto view = drawer_.draw(placed.in_map, camera, (placed.map_from_odom * odom_from_camera).inverse());
  if (!view) {
    EDGESPLAT_LOG_WARN("tracking", "the map was not drawn", "why", view.error().context);
    return std::nullopt;
  }
  draw_ms_.record(to_seconds(clock_.now() - began) * 1e3);
  return tracking::GaussianPicture{std::move(view->picture), std::move(view->depth_m),
                                   std::move(view->alpha)};
}

}  // namespace edgesplat::app
