// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/pointcloud/voxel_key.hpp"
#include "robot/tracking/index_pool.hpp"
#include "robot/tracking/plane.hpp"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace edgesplat::tracking {

struct PlaneMapConfig {
  double root_voxel_m = 1.0;
  int max_layer = 2;
  float plane_sigma_max_m = 0.05F;
  std::uint32_t plane_min_points = 6;
  std::uint32_t plane_freeze_points = 3000;
  double half_extent_m = 100.0;
  std::size_t max_bytes = std::size_t{256} << 20U;
};

struct MapPoint {
  Eigen::Vector3d p_in_odom_m;
  Symmetric3f covariance_m2;                             ///< of the measurement, in odom
  Symmetric3f pose_covariance_m2 = Symmetric3f::Zero();  ///< what the pose's uncertainty adds
};

/// A plane near a point, and the point seen from the plane's centre.
struct PlaneMatch {
  const Plane* plane = nullptr;  ///< valid until the map changes
  Eigen::Vector3f from_centre_m;
  std::uint32_t id = 0;  ///< of the plane, below PlaneMap::plane_ids(), as long as the map does not change
};

/// The local map: cubic root cells in a hash, each split in eight as long as its points are no plane.
/// Bounded: a cell holds sums, not points, except the first few until they show what the cell is.
/// Single-owner; look-ups may run in parallel while nothing is inserted.
class PlaneMap {
 public:
  explicit PlaneMap(const PlaneMapConfig& config);

  /// `lidar_in_odom_m`: where it was seen from.
  void insert(const MapPoint& point, const Eigen::Vector3d& lidar_in_odom_m);
  /// The plane of the smallest cell that holds the point and has one; nothing where the map is empty or
  /// rough.
  [[nodiscard]] PlaneMatch find(const Eigen::Vector3d& p_in_odom_m) const;
  /// The same in the root cell beyond the face nearest to the point.
  [[nodiscard]] PlaneMatch find_beyond_face(const Eigen::Vector3d& p_in_odom_m) const;
  /// Forgets the cells outside the box around `centre`, then the farthest ones until the map fits its bytes
  /// with a tenth to spare. Cheap when nothing is to be done.
  void slide(const Eigen::Vector3d& centre_in_odom_m);

  [[nodiscard]] std::size_t bytes() const;
  [[nodiscard]] std::int64_t evicted_roots() const { return evicted_roots_; }
  [[nodiscard]] std::size_t roots() const { return roots_.live(); }
  [[nodiscard]] std::size_t plane_ids() const { return planes_.slots(); }

 private:
  enum class CellState : std::uint8_t { kGathering, kPlane, kSplit, kRough };
  static constexpr std::uint32_t kNone = IndexPool<int>::kNone;
  static constexpr std::size_t kGatherPoints = 16;

  struct Cell {
    PointSums sums;
    CellState state = CellState::kGathering;
    std::uint32_t fitted_count = 0;  ///< points in the last fit
    std::uint32_t plane = kNone;
    std::uint32_t children = kNone;
    std::uint32_t gathered = kNone;
  };
  using Children = std::array<Cell, 8>;
  struct GatheredPoint {
    Eigen::Vector3f p_from_centre_m;
    Symmetric3f covariance_m2;
    Symmetric3f pose_covariance_m2;
  };
  using Gathered = std::array<GatheredPoint, kGatherPoints>;
  struct Root {
    Eigen::Matrix<std::int64_t, 3, 1> index = Eigen::Matrix<std::int64_t, 3, 1>::Zero();
    Cell cell;
    bool live = false;
  };
  /// Where a cell lives; cells move when pools grow, so places are passed, not references.
  struct CellRef {
    std::uint32_t owner;  ///< root or block of children
    std::uint8_t child;   ///< kIsRoot or 0..7
  };
  static constexpr std::uint8_t kIsRoot = 255;

  [[nodiscard]] Cell& cell(CellRef ref);
  [[nodiscard]] std::uint32_t find_root(const Eigen::Matrix<std::int64_t, 3, 1>& index) const;
  std::uint32_t find_or_create_root(const Eigen::Matrix<std::int64_t, 3, 1>& index);
  void grow_table();
  void insert_in(CellRef ref, const GatheredPoint& point, int layer);
  void descend(CellRef ref, const GatheredPoint& point, int layer);
  void gather(CellRef ref, const GatheredPoint& point, int layer);
  void refine(CellRef ref, const GatheredPoint& point, int layer);
  void split(CellRef ref, int layer);
  [[nodiscard]] PlaneMatch find_in(const Eigen::Matrix<std::int64_t, 3, 1>& index,
                                   Eigen::Vector3f offset) const;
  void release_cell(Cell& cell);
  void erase_root(std::uint32_t root);
  [[nodiscard]] Plane as_seen(const Plane& fitted) const;
  [[nodiscard]] float quarter_edge(int layer) const;

  PlaneMapConfig config_;
  double inverse_root_ = 1.0;
  IndexPool<Root> roots_;
  IndexPool<Children> children_;
  IndexPool<Plane> planes_;
  IndexPool<Gathered> gathered_;
  std::vector<std::uint32_t> table_;  ///< open addressing: kNone or index in roots_
  std::size_t root_slots_ = 0;        ///< roots ever allocated, to walk over all
  Eigen::Vector3d last_slide_m_ = Eigen::Vector3d::Zero();
  Eigen::Vector3f to_lidar_m_ = Eigen::Vector3f::UnitZ();  ///< from the point that is being inserted
  std::int64_t evicted_roots_ = 0;
};

}  // namespace edgesplat::tracking
