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
/// the camera saw nothing. Where to look is worked out once (8 bytes a pixel). Pictures may come out smaller
/// by a whole factor, each pixel the mean of those it is made of; what is left over at the right and lower
/// edge is cut off. Immutable and thread-safe after construction. Source: direct inverse mapping, as
/// cv::undistort.
class Undistorter {
 public:
  /// `shrink`: 1 (full size) to the shorter side of the picture.
  explicit Undistorter(const geometry::CameraModel& camera, int shrink = 1);

  /// Of the pictures that come out.
  [[nodiscard]] const geometry::CameraModel& model() const { return model_; }
  /// The picture has the size of the camera's.
  [[nodiscard]] bool fits(const sensor::ImageRgb8& picture) const {
    return picture.width_px == full_.width_px && picture.height_px == full_.height_px;
  }
  /// The picture must fit.
  [[nodiscard]] sensor::ImageRgb8 apply(const sensor::ImageRgb8& picture) const;
  /// [H,W] 1 where the camera saw all of the pixel, 0 elsewhere.
  [[nodiscard]] std::span<const float> seen() const { return seen_; }

 private:
  struct Place {
    float x, y;  ///< in the distorted picture, px
  };
  static constexpr Place kNowhere{-1.0F, -1.0F};
  [[nodiscard]] sensor::ImageRgb8 resample(const sensor::ImageRgb8& picture) const;

  geometry::CameraModel full_;   ///< undistorted, at full size
  geometry::CameraModel model_;  ///< the same, shrunk
  int shrink_;
  std::vector<Place> places_;  ///< [H,W] at full size; empty: the camera has no distortion
  std::vector<float> seen_;    ///< shrunk
};

}  // namespace edgesplat::image
