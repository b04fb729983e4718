// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/camera_model.hpp"
#include "common/sensor/image.hpp"

namespace edgesplat::render {

/// The pinhole camera without distortion that the renderer draws with: same size, focal lengths and principal
/// point. A fisheye camera keeps its focal length at the centre; what lies beyond the pinhole's picture is
/// cut off.
[[nodiscard]] geometry::CameraModel undistorted_model(const geometry::CameraModel& camera);

/// Resamples a camera's picture as undistorted_model(camera) would have taken it, bilinear, black where the
/// camera saw nothing. The picture must have the camera's size. Source: direct inverse mapping, as
/// cv::undistort.
[[nodiscard]] sensor::ImageRgb8 undistort(const sensor::ImageRgb8& image,
                                          const geometry::CameraModel& camera);

}  // namespace edgesplat::render
