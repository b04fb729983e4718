// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/view.hpp"

namespace edgesplat::splat {

Result<View> View::from(const geometry::CameraModel& camera,
                        const geometry::RigidTransform& camera_from_map) {
  if (const Status valid = camera.validate(); !valid)
    return fail(Errc::kInvalidArgument, valid.error().context);
  if (camera.has_distortion())
    return fail(Errc::kInvalidArgument, "the renderer draws pictures without distortion: undistort first");
  if (!camera_from_map.is_finite()) return fail(Errc::kInvalidArgument, "the camera's pose is not finite");
  View view;
  view.width_px = camera.width_px;
  view.height_px = camera.height_px;
  view.fisheye = camera.kind == geometry::CameraKind::kFisheye;
  view.fx_px = static_cast<float>(camera.fx_px);
  view.fy_px = static_cast<float>(camera.fy_px);
  view.cx_px = static_cast<float>(camera.cx_px);
  view.cy_px = static_cast<float>(camera.cy_px);
  const Eigen::Matrix3d rotation = camera_from_map.rotation.toRotationMatrix();
  const Eigen::Vector3d position = camera_from_map.inverse().translation_m;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      view.rotation[static_cast<std::size_t>(3 * row + column)] = static_cast<float>(rotation(row, column));
    }
    view.translation[static_cast<std::size_t>(row)] = static_cast<float>(camera_from_map.translation_m[row]);
    view.position[static_cast<std::size_t>(row)] = static_cast<float>(position[row]);
  }
  return view;
}

}  // namespace edgesplat::splat
