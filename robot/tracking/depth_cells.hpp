// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "robot/tracking/point_noise.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::tracking {

/// A piece of a plane as one picture sees it.
struct PlaneInView {
  Eigen::Vector2f pixel;
  Eigen::Vector3f p_in_camera_m;
  Eigen::Vector3f normal_in_camera;
};

/// A scan's points sorted into cells of a picture: its sparse depth image. Keeps its memory. Single-owner.
class DepthCells {
 public:
  DepthCells() = default;
  /// `noise` of the scan's points, as if measured from the camera's place.
  explicit DepthCells(const PointNoise& noise) : noise_(noise) {}

  void build(std::span<const Eigen::Vector3f> points_in_body_m,
             const geometry::RigidTransform& camera_from_body, const geometry::CameraModel& camera);

  /// False where the scan saw something else than the plane close to its pixel: something in front of it, an
  /// edge, or a place that is not there any more; where the noise is known, also where the points lie on one
  /// side of it by more than their mean can be off: frames and sills stand out of their wall by less than one
  /// point tells.
  [[nodiscard]] bool agree(const PlaneInView& plane) const;
  /// The scan's point nearest to a pixel, in the camera frame, within the reach of agree().
  [[nodiscard]] std::optional<Eigen::Vector3f> nearest(const Eigen::Vector2f& pixel) const;

 private:
  struct Seen {
    Eigen::Vector2f pixel;
    Eigen::Vector3f p_in_camera_m;
  };
  template <typename Visit>
  void around(const Eigen::Vector2f& pixel, const Visit& visit) const;

  std::optional<PointNoise> noise_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> first_;  ///< of each cell in seen_, and the end
  std::vector<Seen> seen_;
  std::vector<Seen> unsorted_;
  std::vector<std::uint32_t> cell_of_;
};

}  // namespace edgesplat::tracking
