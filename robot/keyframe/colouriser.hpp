// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/image.hpp"
#include "common/sensor/rig.hpp"
#include "common/time/time.hpp"
#include "robot/keyframe/depth_grid.hpp"
#include "robot/keyframe/keyframe_config.hpp"
#include "robot/tracking/tracked_group.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

namespace edgesplat::keyframe {

/// A map point and what the camera knows of it.
struct OdomPoint {
  Eigen::Vector3f p_in_odom_m;
  std::array<std::uint8_t, 3> rgb{};
  bool has_colour = false;
};

/// Gives LiDAR points the colours of the camera's pictures. Points wait in a window of time until a picture
/// sees them; a point that other points hide from the camera is not coloured by it (DepthGrid over all points
/// of the window), so colour does not bleed through walls and past edges. Points leave the window with or
/// without colour, each once. Single-owner; cost: one projection per window point and picture.
class Colouriser {
 public:
  Colouriser(const KeyframeConfig& config, const sensor::CameraMount& camera);

  /// Adds the points of a group, oldest first.
  void add_points(const tracking::TrackedGroup& group);
  /// Colours the waiting points that this picture, taken at the group's end, sees.
  void add_image(const tracking::TrackedGroup& group, const sensor::ImageRgb8& image);
  /// Takes every coloured point not taken before; uncoloured ones stay until the window closes over them.
  [[nodiscard]] std::vector<OdomPoint> take_coloured();

  [[nodiscard]] std::size_t waiting() const { return points_.size(); }
  [[nodiscard]] std::int64_t expired_without_colour() const { return expired_without_colour_; }

 private:
  struct Waiting {
    HostTime stamp;
    OdomPoint point;
    bool taken = false;
  };
  struct Projected {
    std::size_t index;
    float u_px, v_px, z_m;
  };
  void expire(HostTime now);
  void project_all(const geometry::RigidTransform& camera_from_odom);

  KeyframeConfig config_;
  sensor::CameraMount camera_;
  DepthGrid depth_;
  std::deque<Waiting> points_;
  std::vector<Projected> projected_;  ///< kept between pictures to save the allocation
  std::int64_t expired_without_colour_ = 0;
};

}  // namespace edgesplat::keyframe
