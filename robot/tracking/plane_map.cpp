// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/plane_map.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::tracking {
namespace {

using Index3 = Eigen::Matrix<std::int64_t, 3, 1>;

Index3 cell_index(const Eigen::Vector3d& p, double inverse_root) {
  return {pointcloud::floor_to_cell(p.x() * inverse_root), pointcloud::floor_to_cell(p.y() * inverse_root),
          pointcloud::floor_to_cell(p.z() * inverse_root)};
}

unsigned octant(const Eigen::Vector3f& p_from_centre) {
  return (p_from_centre.x() >= 0.0F ? 1U : 0U) | (p_from_centre.y() >= 0.0F ? 2U : 0U) |
         (p_from_centre.z() >= 0.0F ? 4U : 0U);
}

/// From the cell's centre to its child's.
Eigen::Vector3f child_offset(unsigned child, float quarter) {
  return {(child & 1U) != 0U ? quarter : -quarter, (child & 2U) != 0U ? quarter : -quarter,
          (child & 4U) != 0U ? quarter : -quarter};
}

}  // namespace

PlaneMap::PlaneMap(const PlaneMapConfig& config)
    : config_(config), inverse_root_(1.0 / config.root_voxel_m), table_(1024, kNone) {}

PlaneMap::Cell& PlaneMap::cell(CellRef ref) {
  return ref.child == kIsRoot ? roots_[ref.owner].cell : children_[ref.owner][ref.child];
}

float PlaneMap::quarter_edge(int layer) const {
  return static_cast<float>(std::ldexp(config_.root_voxel_m, -2 - layer));
}

void PlaneMap::insert(const MapPoint& point, const Eigen::Vector3d& lidar_in_odom_m) {
  to_lidar_m_ = (lidar_in_odom_m - point.p_in_odom_m).cast<float>();
  const Index3 index = cell_index(point.p_in_odom_m, inverse_root_);
  const Eigen::Vector3d centre = (index.cast<double>().array() + 0.5) * config_.root_voxel_m;
  const GatheredPoint local{(point.p_in_odom_m - centre).cast<float>(), point.covariance_m2,
                            point.pose_covariance_m2};
  insert_in({find_or_create_root(index), kIsRoot}, local, 0);
}

void PlaneMap::insert_in(CellRef ref, const GatheredPoint& point, int layer) {
  switch (cell(ref).state) {
    case CellState::kGathering:
      return gather(ref, point, layer);
    case CellState::kSplit:
      return descend(ref, point, layer);
    case CellState::kPlane:
    case CellState::kRough:
      return refine(ref, point, layer);
  }
}

void PlaneMap::descend(CellRef ref, const GatheredPoint& point, int layer) {
  const unsigned child = octant(point.p_from_centre_m);
  GatheredPoint local = point;
  local.p_from_centre_m -= child_offset(child, quarter_edge(layer));
  insert_in({cell(ref).children, static_cast<std::uint8_t>(child)}, local, layer + 1);
}

void PlaneMap::gather(CellRef ref, const GatheredPoint& point, int layer) {
  if (cell(ref).gathered == kNone) {
    const std::uint32_t gathered = gathered_.allocate();
    cell(ref).gathered = gathered;
  }
  Cell& here = cell(ref);
  gathered_[here.gathered][here.sums.count] = point;
  here.sums.add(point.p_from_centre_m, point.covariance_m2, point.pose_covariance_m2);
  if (here.sums.count < config_.plane_min_points) return;
  const PlaneFit fit = fit_plane(here.sums, config_.plane_sigma_max_m);
  if (fit.verdict == PlaneVerdict::kUndecided && here.sums.count < kGatherPoints) return;
  here.fitted_count = here.sums.count;
  if (fit.verdict == PlaneVerdict::kPlane) {
    here.state = CellState::kPlane;
    here.plane = planes_.allocate();
    planes_[here.plane] = as_seen(fit.plane);
    gathered_.release(here.gathered);
    here.gathered = kNone;
    return;
  }
  split(ref, layer);
}

void PlaneMap::split(CellRef ref, int layer) {
  const std::uint32_t gathered = cell(ref).gathered;
  cell(ref).gathered = kNone;
  if (layer >= config_.max_layer) {
    cell(ref).state = CellState::kRough;
  } else {
    const std::uint32_t block = children_.allocate();
    cell(ref).children = block;
    cell(ref).state = CellState::kSplit;
    if (gathered != kNone) {
      const Gathered points = gathered_[gathered];  // a copy: the pool may grow below
      const std::uint32_t count = std::min<std::uint32_t>(cell(ref).sums.count, kGatherPoints);
      for (std::uint32_t i = 0; i < count; ++i) descend(ref, points[i], layer);
    }
  }
  if (gathered != kNone) gathered_.release(gathered);
}

void PlaneMap::refine(CellRef ref, const GatheredPoint& point, int layer) {
  Cell& here = cell(ref);
  if (here.sums.count >= config_.plane_freeze_points) return;
  here.sums.add(point.p_from_centre_m, point.covariance_m2, point.pose_covariance_m2);
  // Refit at every quarter more points: often while the plane still moves, seldom later.
  if (here.sums.count < here.fitted_count + std::max(4U, here.fitted_count / 4U) &&
      here.sums.count < config_.plane_freeze_points) {
    return;
  }
  here.fitted_count = here.sums.count;
  const PlaneFit fit = fit_plane(here.sums, config_.plane_sigma_max_m);
  if (fit.verdict == PlaneVerdict::kPlane) {
    if (here.plane == kNone) here.plane = planes_.allocate();
    planes_[here.plane] = as_seen(fit.plane);
    here.state = CellState::kPlane;
    return;
  }
  if (here.plane != kNone) planes_.release(here.plane);
  here.plane = kNone;
  here.state = CellState::kRough;
  if (layer < config_.max_layer) split(ref, layer);
}

PlaneMatch PlaneMap::find_in(const Index3& index, Eigen::Vector3f offset) const {
  const std::uint32_t root = find_root(index);
  if (root == kNone) return {};
  const Cell* here = &roots_[root].cell;
  for (int layer = 0; here->state == CellState::kSplit; ++layer) {
    const unsigned child = octant(offset);
    offset -= child_offset(child, quarter_edge(layer));
    here = &children_[here->children][child];
  }
  if (here->state != CellState::kPlane) return {};
  const Plane& plane = planes_[here->plane];
  return {&plane, offset - plane.centre_m, here->plane};
}

PlaneMatch PlaneMap::find(const Eigen::Vector3d& p) const {
  const Index3 index = cell_index(p, inverse_root_);
  const Eigen::Vector3d centre = (index.cast<double>().array() + 0.5) * config_.root_voxel_m;
  return find_in(index, (p - centre).cast<float>());
}

PlaneMatch PlaneMap::find_beyond_face(const Eigen::Vector3d& p) const {
  Index3 index = cell_index(p, inverse_root_);
  const Eigen::Vector3d centre = (index.cast<double>().array() + 0.5) * config_.root_voxel_m;
  int axis = 0;
  (p - centre).cwiseAbs().maxCoeff(&axis);
  index(axis) += p(axis) >= centre(axis) ? 1 : -1;
  const Eigen::Vector3d neighbour = (index.cast<double>().array() + 0.5) * config_.root_voxel_m;
  return find_in(index, (p - neighbour).cast<float>());
}

/// A plane is fitted anew when a point comes: it faces the LiDAR that saw it.
Plane PlaneMap::as_seen(const Plane& fitted) const {
  Plane plane = fitted;
  if (plane.normal.dot(to_lidar_m_) < 0.0F) plane.normal = -plane.normal;
  plane.seen_from = to_lidar_m_.normalized();
  return plane;
}

void PlaneMap::release_cell(Cell& here) {
  if (here.plane != kNone) planes_.release(here.plane);
  if (here.gathered != kNone) gathered_.release(here.gathered);
  if (here.children == kNone) return;
  for (Cell& child : children_[here.children]) release_cell(child);
  children_.release(here.children);
}

std::size_t PlaneMap::bytes() const {
  return roots_.live_bytes() + children_.live_bytes() + planes_.live_bytes() + gathered_.live_bytes() +
         table_.size() * sizeof(table_[0]);
}

}  // namespace edgesplat::tracking
