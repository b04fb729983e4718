// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/sensor/image.hpp"
#include "tools/simulate/world.hpp"

namespace edgesplat::simulate {

/// From where and when a picture is taken.
struct CameraView {
  geometry::CameraModel camera;
  geometry::RigidTransform world_from_camera;
  double time_s = 0.0;  ///< poses the movers for the whole picture: global shutter
};

/// What a perfect camera sees, and the truth behind it.
struct CameraPicture {
  sensor::ImageRgbF32 full;   ///< linear radiance, 1 = white paper in full light
  sensor::ImageRgbF32 clean;  ///< the same without movers and their shadows
  sensor::ImageGray8 movers;  ///< at the pixel's centre: 0 static, else mover number, 1..255 (above 255: 255)
  sensor::ImageF32 depth;     ///< camera z of what `full` shows at the pixel's centre, m; 0 = none (sky)
};

/// Renders with one ray a pixel and four where something ends inside the pixel or a surface is seen at a
/// grazing angle. Runs on all cores; the result does not depend on how many there are.
[[nodiscard]] CameraPicture render_picture(const World& world, const CameraView& view);

}  // namespace edgesplat::simulate
