// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/rig.hpp"
#include "kernels/pointcloud/deskew.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/tracking/block_loop.hpp"
#include "robot/tracking/propagation.hpp"
#include "robot/tracking/tracked_group.hpp"
#include "robot/tracking/tracker.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::tracking {

/// The usable points of one group, as columns, and their places in the body frame at the group's end. Keeps
/// its memory between groups. Thread-bound.
class Sweep {
 public:
  Sweep(const sensor::Rig& rig, double max_range_m, BlockLoop& loop);

  /// Takes a group's points, leaving out what is not finite or out of range, and counts those.
  void load(const sync::MeasureGroup& group, TrackingCounters& counters);
  /// Moves all points to the body frame at the path's end. Points older than the path take its first pose.
  void deskew(std::span<const PathKnot> path);
  /// True when the points were measured at different times.
  [[nodiscard]] bool has_point_times() const { return has_point_times_; }

  [[nodiscard]] std::span<const Eigen::Vector3f> points_in_body_m() const { return points_in_body_m_; }
  [[nodiscard]] std::vector<DeskewedPoint> deskewed() const;

 private:
  geometry::RigidTransform body_from_lidar_;
  float min_range_m_;
  float max_range_m_;
  BlockLoop& loop_;
  bool has_point_times_ = true;
  std::vector<Eigen::Vector3f> points_in_lidar_m_;
  std::vector<std::int32_t> before_end_ns_;
  std::vector<float> reflectivity_;
  std::vector<Eigen::Vector3f> points_in_body_m_;
};

}  // namespace edgesplat::tracking
