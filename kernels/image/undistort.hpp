// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/camera_model.hpp"
#include "common/sensor/image.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::image {

/// The pinhole camera without distortion that the renderer draws with: same size, focal lengths and principal
/// point. A fisheye camera keeps its focal length at the centre; what lies beyond the pinhole's picture is
/// cut off.
[[nodiscard]] geometry::CameraModel undistorted_model(const geometry::CameraModel& camera);

/// Resamples pictures of one camera as undistorted_model(camera) would have taken them: bilinear, black where
/// the camera saw nothing. Where to look is worked out once (8 bytes a pixel). Immutable and thread-safe
/// after construction. Source: direct inverse mapping, as cv::undistort.
class Undistorter {
 public:
  explicit Undistorter(const geometry::CameraModel& camera);

  [[nodiscard]] const geometry::CameraModel& model() const { return model_; }
  /// The picture must have the camera's size.
  [[nodiscard]] sensor::ImageRgb8 apply(const sensor::ImageRgb8& picture) const;
  /// [H,W] 1 where the camera saw something, 0 elsewhere.
  [[nodiscard]] std::span<const float> seen() const { return seen_; }

 private:
  struct Place {
    float x, y;  ///< in the distorted picture, px
  };
  geometry::CameraModel model_;
  std::vector<Place> places_;  ///< [H,W]; empty: the camera has no distortion
  std::vector<float> seen_;
};

}  // namespace edgesplat::image
