// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/keyframe.hpp"
#include "common/sensor/image.hpp"
#include "kernels/image/undistort.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace edgesplat::mapping {

/// A measured depth in one pixel.
struct SparseDepth {
  std::uint32_t pixel;  ///< row * width + column
  float depth_m;        ///< z in the camera frame
};

/// A keyframe as the optimiser looks at it: the undistorted picture, what the LiDAR measured in it, and from
/// where.
struct StoredView {
  map::KeyframeId keyframe;
  std::uint32_t pose_version = 0;
  geometry::RigidTransform map_from_camera;
  std::shared_ptr<const image::Undistorter> undistorter;  ///< shared by all views of one camera
  sensor::ImageRgb8 picture;
  bool exposure_known = false;  ///< the picture has the brightness of all others
  std::vector<bool> ignored;    ///< [H,W] pixels not to train on: something moves there; empty: none
  /// [H,W] pixels over the LiDAR's sight that the map has nothing for: training would draw the wrong
  /// Gaussians over them; empty: none
  std::vector<bool> unmapped;
  std::vector<SparseDepth> depths;  ///< in the order of the pixels, one a pixel: the nearest

  [[nodiscard]] const geometry::CameraModel& camera() const { return undistorter->model(); }
  [[nodiscard]] std::size_t size_bytes() const {
    return sizeof(*this) + picture.values.size() + depths.size() * sizeof(SparseDepth) +
           (ignored.size() + unmapped.size()) / 8;
  }
};

/// The nearest of the points in each pixel they fall into; points nearer than 0.1 m or outside are left out.
[[nodiscard]] std::vector<SparseDepth> project_depths(std::span<const map::ColouredPoint> points_in_body,
                                                      const geometry::RigidTransform& camera_from_body,
                                                      const geometry::CameraModel& pinhole);

/// [H,W] what lies over the highest measurement of each stretch of columns (8 px, and two to each side), with
/// `margin_px` to spare: the sky and whatever rises out of the LiDAR's sight. Columns without a measurement
/// have nothing above it. Empty where no pixel has.
[[nodiscard]] std::vector<bool> above_measured(int margin_px, const StoredView& view);

/// `picture`: the keyframe's, decoded; kInvalidArgument unless it fits the undistorter. The keyframe must
/// have a camera. What lies over the LiDAR's sight is unmapped.
[[nodiscard]] Result<StoredView> make_view(const map::Keyframe& keyframe,
                                           const geometry::RigidTransform& map_from_body,
                                           const sensor::ImageRgb8& picture,
                                           std::shared_ptr<const image::Undistorter> undistorter);

}  // namespace edgesplat::mapping
