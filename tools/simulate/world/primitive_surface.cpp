// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/primitive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

/// Face of a box (or, near enough, of a tapered box) on which a local point lies.
std::uint32_t box_face(const Vector3d& p, const Vector3d& half) {
  int axis = 0;
  double best = -1e30;
  for (int i = 0; i < 3; ++i) {
    const double inside = std::abs(p[i]) - half[i];
    if (inside > best) {
      best = inside;
      axis = i;
    }
  }
  return static_cast<std::uint32_t>(2 * axis + (p[axis] > 0.0 ? 1 : 0));
}

Vector3d face_normal(std::uint32_t face) {
  Vector3d normal = Vector3d::Zero();
  normal[static_cast<int>(face / 2)] = face % 2 == 1 ? 1.0 : -1.0;
  return normal;
}

/// u to the right of a viewer outside, v upwards (north for level faces).
Vector2d box_uv(std::uint32_t face, const Vector3d& p, const Vector3d& half) {
  const double sign = face % 2 == 1 ? 1.0 : -1.0;
  switch (face / 2) {
    case 0:
      return {half.y() + sign * p.y(), half.z() + p.z()};
    case 1:
      return {half.x() - sign * p.x(), half.z() + p.z()};
    default:
      return {half.x() + p.x(), half.y() + sign * p.y()};
  }
}

Vector3d box_point(std::uint32_t face, const Vector2d& uv, const Vector3d& half) {
  const double sign = face % 2 == 1 ? 1.0 : -1.0;
  switch (face / 2) {
    case 0:
      return {sign * half.x(), sign * (uv.x() - half.y()), uv.y() - half.z()};
    case 1:
      return {-sign * (uv.x() - half.x()), sign * half.y(), uv.y() - half.z()};
    default:
      return {uv.x() - half.x(), sign * (uv.y() - half.y()), sign * half.z()};
  }
}

/// A tapered box is the image of its box under p -> p * scale(z) + shift(z); this undoes it.
Vector3d untaper(const Primitive& p, const Vector3d& q) {
  const double t = (q.z() + p.half_m.z()) / (2.0 * p.half_m.z());
  return {(q.x() - t * p.top_shift_m) / std::max(1e-6, 1.0 + t * (p.top_scale.x() - 1.0)),
          q.y() / std::max(1e-6, 1.0 + t * (p.top_scale.y() - 1.0)), q.z()};
}

Vector3d taper(const Primitive& p, const Vector3d& q) {
  const double t = (q.z() + p.half_m.z()) / (2.0 * p.half_m.z());
  return {q.x() * (1.0 + t * (p.top_scale.x() - 1.0)) + t * p.top_shift_m,
          q.y() * (1.0 + t * (p.top_scale.y() - 1.0)), q.z()};
}

Vector3d taper_normal(const Primitive& p, std::uint32_t face) {
  Vector3d normal = face_normal(face);
  const double height = 2.0 * p.half_m.z();
  const double sign = face % 2 == 1 ? 1.0 : -1.0;
  if (face < 2) {
    normal.z() = -(p.half_m.x() * (p.top_scale.x() - 1.0) + sign * p.top_shift_m) / height;
  } else if (face < 4) {
    normal.z() = -p.half_m.y() * (p.top_scale.y() - 1.0) / height;
  }
  return normal.normalized();
}

SurfacePoint round_surface(const Primitive& p, const Vector3d& q) {
  const double radius = p.half_m.x();
  const bool oval = p.shape == Shape::kEllipsoid;
  const double angle = oval ? std::atan2(q.y() / p.half_m.y(), q.x() / radius) : std::atan2(q.y(), q.x());
  const double u = (angle + pi) * radius;
  SurfacePoint s;
  if (oval) {
    s.normal = q.cwiseQuotient(p.half_m.cwiseAbs2()).normalized();
    s.uv_m = {u, (std::asin(std::clamp(q.z() / p.half_m.z(), -1.0, 1.0)) + pi / 2) * p.half_m.z()};
  } else if (p.shape == Shape::kCapsule) {
    s.normal = (q - Vector3d(0, 0, std::clamp(q.z(), -p.half_m.z(), p.half_m.z()))).normalized();
    s.uv_m = {u, q.z() + p.half_m.z() + radius};
  } else {
    const bool end =
        p.shape == Shape::kCylinder && std::abs(q.z()) - p.half_m.z() > q.head<2>().norm() - radius;
    s.face = !end ? 0U : q.z() > 0.0 ? 2U : 1U;
    s.normal = end ? Vector3d(0, 0, q.z() > 0.0 ? 1.0 : -1.0) : Vector3d(q.x(), q.y(), 0.0).normalized();
    s.uv_m = end ? Vector2d(q.x() + radius, q.y() + radius) : Vector2d(u, q.z() + p.half_m.z());
  }
  return s;
}

FacePoint round_point(const Primitive& p, std::uint32_t face, const Vector2d& uv) {
  const double radius = p.half_m.x();
  const double angle = uv.x() / radius - pi;
  const Vector3d around(std::cos(angle), std::sin(angle), 0.0);
  if (p.shape == Shape::kEllipsoid) {
    const double latitude = uv.y() / p.half_m.z() - pi / 2;
    const Vector3d unit(std::cos(latitude) * around.x(), std::cos(latitude) * around.y(), std::sin(latitude));
    return {unit.cwiseProduct(p.half_m), unit.cwiseQuotient(p.half_m).normalized()};
  }
  if (p.shape == Shape::kCapsule) {
    const double z = uv.y() - p.half_m.z() - radius;
    const double beyond = z - std::clamp(z, -p.half_m.z(), p.half_m.z());
    const double flat = std::sqrt(std::max(0.0, radius * radius - beyond * beyond));
    const Vector3d out = around * flat + Vector3d(0, 0, beyond);
    return {out + Vector3d(0, 0, z - beyond), out / radius};
  }
  if (face == 0) return {around * radius + Vector3d(0, 0, uv.y() - p.half_m.z()), around};
  const double sign = face == 2 ? 1.0 : -1.0;
  return {Vector3d(uv.x() - radius, uv.y() - radius, sign * p.half_m.z()), Vector3d(0, 0, sign)};
}

}  // namespace

SurfacePoint surface_at(const Primitive& p, const Vector3d& p_in_world_m) {
  const Vector3d q = p.to_local(p_in_world_m);
  SurfacePoint s;
  switch (p.shape) {
    case Shape::kBox:
      s.face = box_face(q, p.half_m);
      s.normal = face_normal(s.face);
      s.uv_m = box_uv(s.face, q, p.half_m);
      break;
    case Shape::kTaperedBox: {
      const Vector3d straight = untaper(p, q);
      s.face = box_face(straight, p.half_m);
      s.normal = taper_normal(p, s.face);
      s.uv_m = box_uv(s.face, straight, p.half_m);
      break;
    }
    case Shape::kQuad:
      s.uv_m = {q.x() + p.half_m.x(), q.y() + p.half_m.y()};
      break;
    default:
      s = round_surface(p, q);
      break;
  }
  s.uv_m = s.uv_m.cwiseMax(0.0);
  if (p.shape == Shape::kTube) s.normal = -s.normal;
  if (!p.aligned) s.normal = p.local_from_world.transpose() * s.normal;
  return s;
}

Vector2d face_size_m(const Primitive& p, std::uint32_t face) {
  const Vector3d size = 2.0 * p.half_m;
  switch (p.shape) {
    case Shape::kBox:
    case Shape::kTaperedBox:
      if (face > 5) return Vector2d::Zero();
      return face < 2   ? Vector2d(size.y(), size.z())
             : face < 4 ? Vector2d(size.x(), size.z())
                        : Vector2d(size.x(), size.y());
    case Shape::kQuad:
      return face == 0 ? Vector2d(size.x(), size.y()) : Vector2d::Zero();
    case Shape::kCylinder:
      if (face == 1 || face == 2) return {size.x(), size.x()};
      [[fallthrough]];
    case Shape::kTube:
      return face == 0 ? Vector2d(pi * size.x(), size.z()) : Vector2d::Zero();
    case Shape::kEllipsoid:
      return face == 0 ? Vector2d(pi * size.x(), pi * p.half_m.z()) : Vector2d::Zero();
    case Shape::kCapsule:
      return face == 0 ? Vector2d(pi * size.x(), size.z() + size.x()) : Vector2d::Zero();
  }
  return Vector2d::Zero();
}

FacePoint face_point(const Primitive& p, std::uint32_t face, const Vector2d& uv) {
  FacePoint out{Vector3d::Zero(), Vector3d::UnitZ()};
  switch (p.shape) {
    case Shape::kBox:
      out = {box_point(face, uv, p.half_m), face_normal(face)};
      break;
    case Shape::kTaperedBox:
      out = {taper(p, box_point(face, uv, p.half_m)), taper_normal(p, face)};
      break;
    case Shape::kQuad:
      out.p_in_world_m = {uv.x() - p.half_m.x(), uv.y() - p.half_m.y(), 0.0};
      break;
    default:
      out = round_point(p, face, uv);
      break;
  }
  out.p_in_world_m = p.to_world(out.p_in_world_m);
  if (p.shape == Shape::kTube) out.normal = -out.normal;
  if (!p.aligned) out.normal = p.local_from_world.transpose() * out.normal;
  return out;
}

}  // namespace edgesplat::simulate
