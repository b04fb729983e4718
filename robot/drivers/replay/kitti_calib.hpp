// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/rig.hpp"

#include <string_view>

namespace edgesplat::replay {

/// The left colour camera of a KITTI car from the text of its calibration (keys P_rect_02, R_rect_00,
/// Tr_velo_to_cam; other lines are ignored): pixel = P_rect_02 * R_rect_00 * Tr_velo_to_cam * p_in_lidar. The
/// fourth column of P_rect_02 moves the camera's origin, which is part of body_from_camera; body = LiDAR. The
/// picture's size is not in the file. kInvalidConfig names the line or the missing key.
[[nodiscard]] Result<sensor::CameraMount> parse_kitti_camera(std::string_view text,
                                                             std::string_view file_name, int width_px,
                                                             int height_px);

}  // namespace edgesplat::replay
