// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/depth_picture.hpp"
#include "kernels/mapping/ground.hpp"
#include "kernels/mapping/stored_view.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::mapping {

struct MovingOptions {
  bool enabled = true;
  std::size_t views = 6;  ///< so many of the newest views are compared with a new one, 0..64
  LookThrough by;
  float radius_m = 0.12F;    ///< around a measurement that moved, 0.01..2
  float tallest_m = 2.3F;    ///< what moves and is measured up to here stands on the floor, 0..10
  float thickness_m = 0.5F;  ///< of what moves, before and behind what was measured of it, 0.05..5
};

/// The measurements of `view` at places that another view found empty: what was there moved.
[[nodiscard]] std::vector<SparseDepth> moving_depths(const StoredView& view, const DepthPicture& other,
                                                     const LookThrough& by);

/// Where something that moves hides the world in one view's picture, and how far away it is. Single-owner.
class MovingMask {
 public:
  explicit MovingMask(const StoredView& view);

  /// The pixels around a measurement of something that moves, and those from there down to the floor, where
  /// the LiDAR may not look. `floor`: null where it is not known.
  void mark(const SparseDepth& measured, const GroundPlane* floor, const MovingOptions& options);
  /// The pixels around a place of the map.
  void mark(const Eigen::Vector3f& p_in_map_m, float radius_m);
  [[nodiscard]] bool empty() const { return depth_m_.empty(); }
  /// A place of the map lies where that thing is.
  [[nodiscard]] bool holds(const Eigen::Vector3f& p_in_map_m, float thickness_m) const;
  /// A place of the map lies there or behind it: its colour in the picture is not its own.
  [[nodiscard]] bool hides(const Eigen::Vector3f& p_in_map_m, float thickness_m) const;
  /// Takes the pixels out of the view's training. `view`: the one it was made for.
  void hide_in(StoredView& view) const;

 private:
  /// How far the place lies behind what moves in front of it; nothing where nothing does.
  [[nodiscard]] std::optional<float> behind_m(const Eigen::Vector3f& p_in_map_m) const;
  void mark_around(const Eigen::Vector3f& p_in_camera_m, float radius_m);

  geometry::RigidTransform map_from_camera_;
  geometry::CameraModel camera_;
  PixelProjector projector_;
  std::vector<float> depth_m_;  ///< [H,W] 0 where nothing moves; empty: nowhere
};

}  // namespace edgesplat::mapping
