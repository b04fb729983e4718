// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/image/patch.hpp"
#include "robot/tracking/index_pool.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::tracking {

/// Pyramid levels of a patch: 8, 16 and 32 pixels wide.
inline constexpr int kPatchLevels = 3;

/// How a visual point looked once: patches, never the picture.
struct VisualObservation {
  Eigen::Vector3f from_camera_m;  ///< camera to point, in odom
  /// Steps on the point's plane, in odom, for one pixel to the right and one down in the picture.
  Eigen::Vector3f right_m;
  Eigen::Vector3f down_m;
  /// By how much of itself the depth grows with that.
  Eigen::Vector2f growth = Eigen::Vector2f::Zero();
  float log_gain = 0.0F;
  std::array<image::BorderedPatch, kPatchLevels> patches;
};

/// A place on a plane of the LiDAR's map that pictures can be aligned with.
struct VisualPoint {
  static constexpr std::size_t kMaxObservations = 4;
  Eigen::Vector3d p_in_odom_m = Eigen::Vector3d::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  Eigen::Vector3f doubt_m = Eigen::Vector3f::Zero();  ///< one standard deviation, along the first ray
  std::array<std::uint32_t, kMaxObservations> observations{};  ///< oldest first
  std::uint8_t observation_count = 0;
  std::uint8_t good = 0;  ///< how often it matched, up to 255
  std::uint8_t bad = 0;   ///< how often in a row it did not
  bool live = false;
};

/// The visual points around the robot, bounded in bytes: the farthest are forgotten. Points are walked over,
/// not looked up: there are some ten thousand, and each picture asks for those in its view, not near a place.
/// Single-owner; equal histories give equal indices.
class VisualMap {
 public:
  explicit VisualMap(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// The new point has no observation yet.
  std::uint32_t add(const VisualPoint& point);
  /// Adds the newest look; above kMaxObservations the second oldest goes: the oldest one drifted least.
  void observe(std::uint32_t point, const VisualObservation& observation);
  void erase(std::uint32_t point);
  /// Forgets what is out of a box around `centre`, and the farthest points above the size allowed, with a
  /// tenth to spare.
  void slide(const Eigen::Vector3d& centre_in_odom_m, double half_extent_m);

  /// Indices run below this; some are not live.
  [[nodiscard]] std::uint32_t slots() const { return slots_; }
  [[nodiscard]] VisualPoint& point(std::uint32_t index) { return points_[index]; }
  [[nodiscard]] const VisualPoint& point(std::uint32_t index) const { return points_[index]; }
  [[nodiscard]] VisualObservation& observation(std::uint32_t index) { return observations_[index]; }
  [[nodiscard]] const VisualObservation& observation(std::uint32_t index) const {
    return observations_[index];
  }
  [[nodiscard]] std::size_t size() const { return points_.live(); }
  [[nodiscard]] std::size_t bytes() const { return points_.live_bytes() + observations_.live_bytes(); }

 private:
  std::size_t max_bytes_;
  IndexPool<VisualPoint> points_;
  IndexPool<VisualObservation> observations_;
  std::uint32_t slots_ = 0;
};

}  // namespace edgesplat::tracking
