// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <limits>

namespace edgesplat::simulate {

enum class Shape : std::uint8_t {
  kBox,         ///< half extents
  kTaperedBox,  ///< box whose top face is scaled by `top_scale` and moved by `top_shift_m` along x
  kQuad,        ///< half_m.x() by half_m.y() in the local plane z = 0, seen from both sides
  kCylinder,    ///< radius half_m.x(), half length half_m.z() along local z, closed
  kTube,        ///< the same without its ends; a vault: its normal points to the axis
  kEllipsoid,   ///< half axes
  kCapsule,     ///< radius half_m.x() around a segment of half length half_m.z() along local z
};

inline constexpr std::uint32_t kFacesPerPrimitive = 8;
inline constexpr double kNearestRange_m = 0.05;  ///< of World::cast
inline constexpr double kFarthestRange_m = 200.0;

/// One solid or surface. A box's faces are numbered 2 * axis + (positive side); a cylinder's side is 0 and
/// its ends 1 (bottom) and 2 (top); a quad's front (local +z) is 0 and its back 1; all else is face 0.
struct Primitive {
  Shape shape = Shape::kBox;
  bool aligned = true;  ///< local_from_world is the identity
  std::uint32_t material = 0;
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_m = Eigen::Vector3d::Ones();
  Eigen::Vector2d top_scale = Eigen::Vector2d::Ones();
  double top_shift_m = 0.0;
  Eigen::Matrix3d local_from_world = Eigen::Matrix3d::Identity();

  void rotate(const Eigen::Matrix3d& world_from_local);
  [[nodiscard]] Eigen::Vector3d to_local(const Eigen::Vector3d& p_in_world_m) const;
  [[nodiscard]] Eigen::Vector3d to_world(const Eigen::Vector3d& p_in_local_m) const;
};

struct Bounds {
  Eigen::Vector3d lo_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d hi_m = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
  void extend(const Bounds& other) {
    lo_m = lo_m.cwiseMin(other.lo_m);
    hi_m = hi_m.cwiseMax(other.hi_m);
  }
};
[[nodiscard]] Bounds bounds(const Primitive& primitive);

/// Distance along the unit `direction` to the nearest surface point in (from_m, to_m); `to_m` where there is
/// none. From inside a solid its inner surface is seen.
[[nodiscard]] double intersect(const Primitive& primitive, const Eigen::Vector3d& origin_m,
                               const Eigen::Vector3d& direction, double from_m, double to_m);

/// What there is at a point of a primitive's surface.
struct SurfacePoint {
  std::uint32_t face = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< world frame, unit, outwards
  Eigen::Vector2d uv_m = Eigen::Vector2d::Zero();     ///< >= 0; u to the right and v upwards for a viewer
};
[[nodiscard]] SurfacePoint surface_at(const Primitive& primitive, const Eigen::Vector3d& p_in_world_m);

/// Size of a face's texture rectangle in metres; zero for a face that the shape does not have.
[[nodiscard]] Eigen::Vector2d face_size_m(const Primitive& primitive, std::uint32_t face);
/// Inverse of surface_at() on one face: the point in the world and the outward normal there.
struct FacePoint {
  Eigen::Vector3d p_in_world_m;
  Eigen::Vector3d normal;
};
[[nodiscard]] FacePoint face_point(const Primitive& primitive, std::uint32_t face,
                                   const Eigen::Vector2d& uv_m);

}  // namespace edgesplat::simulate
