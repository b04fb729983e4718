// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"
#include "kernels/pointcloud/deskew.hpp"
#include "kernels/pointcloud/voxel_downsample.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/tracking/block_loop.hpp"
#include "robot/tracking/calibration.hpp"
#include "robot/tracking/propagation.hpp"
#include "robot/tracking/tracked_group.hpp"
#include "robot/tracking/tracker.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::tracking {

/// The usable points of one group, of all LiDARs, as columns, and their places in the body frame at one
/// moment. Keeps its memory between groups. Thread-bound.
class Sweep {
 public:
  Sweep(const sensor::Rig& rig, double max_range_m, BlockLoop& loop);

  /// Takes a group's points, leaving out what is not finite or out of range, and counts those.
  void load(const sync::MeasureGroup& group, TrackingCounters& counters);
  /// Moves all points to the body frame of one moment, given as `body_from_odom`. Points from outside the
  /// path's time take its nearest pose (with a delay it is made longer by it); without point times all are
  /// taken as measured at that moment.
  void deskew(std::span<const PathKnot> path, const geometry::RigidTransform& body_from_odom,
              const SensorCalibration& calibration);
  /// True when the points were measured at different times.
  [[nodiscard]] bool has_point_times() const { return has_point_times_; }
  /// Mean of the points' times: the moment that they tell most about. The group's end without point times.
  [[nodiscard]] HostTime middle() const { return middle_; }

  [[nodiscard]] std::span<const Eigen::Vector3f> points_in_body_m() const { return points_in_body_m_; }
  /// Indices of one point of every cell of a grid in the body frame (pointcloud::VoxelDownsampler). Found
  /// once for each edge and deskewing; valid until the next deskewing.
  [[nodiscard]] std::span<const std::uint32_t> thinned(double edge_m);
  /// Which of the rig's LiDARs measured each point.
  [[nodiscard]] std::span<const std::uint8_t> units() const { return units_; }
  /// The points moved on to another frame, with their reflectivity.
  [[nodiscard]] std::vector<DeskewedPoint> deskewed(const geometry::RigidTransform& target_from_body) const;

 private:
  struct Unit {
    float min_range_m;
    float max_range_m;
    Eigen::Matrix3f rotation;  ///< from this LiDAR's frame to the first one's
    Eigen::Vector3f translation_m;
  };
  struct Thinned {
    double edge_m;
    pointcloud::VoxelDownsampler downsampler;
    std::span<const std::uint32_t> kept;
    bool is_current;
  };
  std::vector<Unit> units_of_rig_;
  BlockLoop& loop_;
  bool has_point_times_ = true;
  HostTime end_{};
  HostTime middle_{};
  std::vector<Eigen::Vector3f> points_in_lidar_m_;  ///< in the first one's frame, when the ray was fired
  std::vector<std::uint8_t> units_;
  std::vector<std::int32_t> before_end_ns_;
  std::vector<float> reflectivity_;
  std::vector<Eigen::Vector3f> points_in_body_m_;
  std::vector<Thinned> thinned_;  ///< an entry for every edge that was ever asked for: two at most
};

}  // namespace edgesplat::tracking
