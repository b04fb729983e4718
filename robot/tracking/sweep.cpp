// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/sweep.hpp"

#include <algorithm>
#include <limits>

namespace edgesplat::tracking {
namespace {

constexpr std::size_t kBlockSize = 4096;

std::int32_t clamp_ns(nanoseconds before_end) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(before_end.count(), -kMost, kMost));
}

}  // namespace

Sweep::Sweep(const sensor::Rig& rig, double max_range_m, BlockLoop& loop) : loop_(loop) {
  for (std::size_t unit = 0; unit < rig.lidar_count(); ++unit) {
    const sensor::LidarMount mount = rig.mount_of(unit);
    const geometry::RigidTransform first_from_this = rig.body_from_lidar.inverse() * mount.body_from_lidar;
    units_of_rig_.push_back({static_cast<float>(mount.model.min_range_m),
                             static_cast<float>(std::min(max_range_m, mount.model.max_range_m)),
                             first_from_this.rotation.toRotationMatrix().cast<float>(),
                             first_from_this.translation_m.cast<float>()});
  }
}

void Sweep::load(const sync::MeasureGroup& group, TrackingCounters& counters) {
  has_point_times_ = group.has_point_times;
  end_ = group.end;
  std::int64_t before_end_sum_ns = 0;
  points_in_lidar_m_.clear();
  before_end_ns_.clear();
  reflectivity_.clear();
  units_.clear();
  for (const sync::GroupPoint& point : group.points) {
    if (!point.p_in_lidar_m.allFinite() || point.unit >= units_of_rig_.size()) {
      ++counters.bad_points;
      continue;
    }
    const Unit& unit = units_of_rig_[point.unit];
    const float range_squared = point.p_in_lidar_m.squaredNorm();
    if (range_squared < unit.min_range_m * unit.min_range_m ||
        range_squared > unit.max_range_m * unit.max_range_m) {
      ++counters.out_of_range_points;
    } else {
      points_in_lidar_m_.push_back(
          point.unit == 0 ? point.p_in_lidar_m
                          : Eigen::Vector3f(unit.rotation * point.p_in_lidar_m + unit.translation_m));
      units_.push_back(point.unit);
      before_end_ns_.push_back(has_point_times_ ? std::max(point.before_end_ns, 0) : 0);
      before_end_sum_ns += before_end_ns_.back();
      reflectivity_.push_back(point.reflectivity);
    }
  }
  const auto count = std::max<std::int64_t>(1, static_cast<std::int64_t>(before_end_ns_.size()));
  middle_ = end_ - nanoseconds(before_end_sum_ns / count);
}

void Sweep::deskew(std::span<const PathKnot> path, const geometry::RigidTransform& body_from_odom,
                   const SensorCalibration& calibration) {
  const geometry::RigidTransform& body_from_lidar = calibration.body_from_lidar;
  const nanoseconds delay = from_seconds(calibration.lidar_delay_s);
  std::vector<PathKnot> longer;
  if (delay != nanoseconds(0)) {
    longer.assign(path.begin(), path.end());
    lengthen(longer, std::max(delay, -delay));
    path = longer;
  }
  std::vector<pointcloud::MotionKnot> knots;
  for (const PathKnot& knot : path) {
    knots.push_back(
        {clamp_ns(end_ + delay - knot.stamp), body_from_odom * knot.odom_from_body * body_from_lidar});
  }
  if (!has_point_times_) knots = {{0, body_from_lidar}};
  for (Thinned& thinned : thinned_) thinned.is_current = false;
  points_in_body_m_.resize(points_in_lidar_m_.size());
  const std::span<const Eigen::Vector3f> points = points_in_lidar_m_;
  const std::span<const std::int32_t> times = before_end_ns_;
  const std::span<Eigen::Vector3f> moved = points_in_body_m_;
  loop_.run(points.size(), kBlockSize, [&](std::size_t, std::size_t first, std::size_t last) {
    const std::size_t count = last - first;
    pointcloud::deskew(points.subspan(first, count), times.subspan(first, count), knots,
                       moved.subspan(first, count));
  });
}

std::span<const std::uint32_t> Sweep::thinned(double edge_m) {
  auto found = std::find_if(thinned_.begin(), thinned_.end(),
                            [&](const Thinned& thinned) { return thinned.edge_m == edge_m; });
  if (found == thinned_.end()) found = thinned_.insert(thinned_.end(), Thinned{edge_m, {}, {}, false});
  if (!found->is_current) {
    found->kept = found->downsampler.run(points_in_body_m_, static_cast<float>(edge_m));
    found->is_current = true;
  }
  return found->kept;
}

std::vector<DeskewedPoint> Sweep::deskewed(const geometry::RigidTransform& target_from_body) const {
  const Eigen::Matrix3f rotation = target_from_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = target_from_body.translation_m.cast<float>();
  std::vector<DeskewedPoint> points(points_in_body_m_.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {rotation * points_in_body_m_[i] + translation, reflectivity_[i]};
  }
  return points;
}

}  // namespace edgesplat::tracking
