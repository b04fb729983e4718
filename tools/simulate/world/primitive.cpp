// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/primitive.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector3d;

struct LocalRay {
  Vector3d o;
  Vector3d d;
  double from_m;
  double to_m;
  /// The first of two crossings that lies in the ray's interval.
  [[nodiscard]] double pick(double enter, double leave) const {
    if (enter > from_m) return enter < to_m ? enter : to_m;
    return leave > from_m && leave < to_m ? leave : to_m;
  }
};

double safe_inverse(double d) {
  return 1.0 / (std::abs(d) < 1e-15 ? std::copysign(1e-15, d) : d);
}

double intersect_box(const Vector3d& half, const LocalRay& ray) {
  double enter = -1e30;
  double leave = 1e30;
  for (int axis = 0; axis < 3; ++axis) {
    const double inverse = safe_inverse(ray.d[axis]);
    const double near = (std::copysign(half[axis], -inverse) - ray.o[axis]) * inverse;
    const double far = (std::copysign(half[axis], inverse) - ray.o[axis]) * inverse;
    enter = std::max(enter, near);
    leave = std::min(leave, far);
  }
  return enter > leave ? ray.to_m : ray.pick(enter, leave);
}

/// One side of a tapered box: slope_x * x + slope_y * y - lean * z <= offset.
struct TaperSide {
  Vector3d normal;  ///< not unit
  double offset;
};

std::array<TaperSide, 4> taper_sides(const Primitive& p) {
  const Vector3d& h = p.half_m;
  const double top_x = h.x() * p.top_scale.x(), top_y = h.y() * p.top_scale.y();
  const auto side = [&](int axis, double sign, double bottom, double top) {
    Vector3d normal = Vector3d::Zero();
    normal[axis] = sign;
    normal.z() = -(top - bottom) / (2.0 * h.z());
    return TaperSide{normal, (top + bottom) / 2.0};
  };
  return {side(0, -1.0, h.x(), top_x - p.top_shift_m), side(0, 1.0, h.x(), top_x + p.top_shift_m),
          side(1, -1.0, h.y(), top_y), side(1, 1.0, h.y(), top_y)};
}

double intersect_tapered(const Primitive& p, const LocalRay& ray) {
  double enter = -1e30;
  double leave = 1e30;
  const auto clip = [&](const Vector3d& normal, double offset) {
    const double inverse = safe_inverse(normal.dot(ray.d));
    const double t = (offset - normal.dot(ray.o)) * inverse;
    if (inverse < 0.0) {
      enter = std::max(enter, t);
    } else {
      leave = std::min(leave, t);
    }
  };
  for (const TaperSide& side : taper_sides(p)) clip(side.normal, side.offset);
  clip(Vector3d::UnitZ(), p.half_m.z());
  clip(-Vector3d::UnitZ(), p.half_m.z());
  return enter > leave ? ray.to_m : ray.pick(enter, leave);
}

double intersect_quad(const Vector3d& half, const LocalRay& ray) {
  const double t = -ray.o.z() * safe_inverse(ray.d.z());
  if (t <= ray.from_m || t >= ray.to_m) return ray.to_m;
  const bool inside =
      std::abs(ray.o.x() + t * ray.d.x()) <= half.x() && std::abs(ray.o.y() + t * ray.d.y()) <= half.y();
  return inside ? t : ray.to_m;
}

/// Both crossings of the infinite cylinder around z; false where the line misses it.
bool cross_cylinder(double radius, const LocalRay& ray, double& enter, double& leave) {
  const double a = ray.d.head<2>().squaredNorm();
  if (a < 1e-18) {
    enter = -1e30;
    leave = 1e30;
    return ray.o.head<2>().squaredNorm() < radius * radius;
  }
  const double b = ray.o.head<2>().dot(ray.d.head<2>());
  const double disc = b * b - a * (ray.o.head<2>().squaredNorm() - radius * radius);
  if (disc < 0.0) return false;
  const double root = std::sqrt(disc);
  enter = (-b - root) / a;
  leave = (-b + root) / a;
  return true;
}

double intersect_cylinder(const Vector3d& half, const LocalRay& ray) {
  double enter = 0.0, leave = 0.0;
  if (!cross_cylinder(half.x(), ray, enter, leave)) return ray.to_m;
  const double inverse = safe_inverse(ray.d.z());
  enter = std::max(enter, (std::copysign(half.z(), -inverse) - ray.o.z()) * inverse);
  leave = std::min(leave, (std::copysign(half.z(), inverse) - ray.o.z()) * inverse);
  return enter > leave ? ray.to_m : ray.pick(enter, leave);
}

double intersect_tube(const Vector3d& half, const LocalRay& ray) {
  double enter = 0.0, leave = 0.0;
  if (!cross_cylinder(half.x(), ray, enter, leave)) return ray.to_m;
  for (const double t : {enter, leave}) {
    if (t > ray.from_m && t < ray.to_m && std::abs(ray.o.z() + t * ray.d.z()) <= half.z()) return t;
  }
  return ray.to_m;
}

double intersect_ellipsoid(const Vector3d& half, const LocalRay& ray) {
  const Vector3d o = ray.o.cwiseQuotient(half), d = ray.d.cwiseQuotient(half);
  const double a = d.squaredNorm(), b = o.dot(d);
  const double disc = b * b - a * (o.squaredNorm() - 1.0);
  if (disc < 0.0) return ray.to_m;
  const double root = std::sqrt(disc);
  return ray.pick((-b - root) / a, (-b + root) / a);
}

/// A convex body's crossings are the outermost of its parts': the cylinder between the ends and the two
/// balls.
double intersect_capsule(const Vector3d& half, const LocalRay& ray) {
  double enter = 1e30, leave = -1e30;
  double t0 = 0.0, t1 = 0.0;
  if (!cross_cylinder(half.x(), ray, t0, t1)) return ray.to_m;
  for (const double t : {t0, t1}) {
    if (std::abs(ray.o.z() + t * ray.d.z()) > half.z()) continue;
    enter = std::min(enter, t);
    leave = std::max(leave, t);
  }
  for (const double end : {-half.z(), half.z()}) {
    const Vector3d o = ray.o - Vector3d(0, 0, end);
    const double b = o.dot(ray.d);
    const double disc = b * b - (o.squaredNorm() - half.x() * half.x());
    if (disc < 0.0) continue;
    const double root = std::sqrt(disc);
    enter = std::min(enter, -b - root);
    leave = std::max(leave, -b + root);
  }
  return enter > leave ? ray.to_m : ray.pick(enter, leave);
}

}  // namespace

void Primitive::rotate(const Eigen::Matrix3d& world_from_local) {
  local_from_world = world_from_local.transpose();
  aligned = local_from_world.isIdentity(0.0);
}

Vector3d Primitive::to_local(const Vector3d& p) const {
  return aligned ? Vector3d(p - centre_m) : Vector3d(local_from_world * (p - centre_m));
}

Vector3d Primitive::to_world(const Vector3d& p) const {
  return aligned ? Vector3d(p + centre_m) : Vector3d(local_from_world.transpose() * p + centre_m);
}

Bounds bounds(const Primitive& p) {
  Vector3d half = p.half_m;
  if (p.shape == Shape::kQuad) half.z() = 0.0;
  if (p.shape == Shape::kCylinder || p.shape == Shape::kTube || p.shape == Shape::kCapsule)
    half.y() = half.x();
  if (p.shape == Shape::kCapsule) half.z() += half.x();
  if (p.shape == Shape::kTaperedBox) {
    half.x() = std::max(half.x(), half.x() * p.top_scale.x() + std::abs(p.top_shift_m));
    half.y() = std::max(half.y(), half.y() * p.top_scale.y());
  }
  const Vector3d reach = p.local_from_world.transpose().cwiseAbs() * half;
  return {p.centre_m - reach, p.centre_m + reach};
}

double intersect(const Primitive& p, const Vector3d& origin_m, const Vector3d& direction, double from_m,
                 double to_m) {
  LocalRay ray{origin_m - p.centre_m, direction, from_m, to_m};
  if (!p.aligned) {
    ray.o = p.local_from_world * ray.o;
    ray.d = p.local_from_world * ray.d;
  }
  switch (p.shape) {
    case Shape::kBox:
      return intersect_box(p.half_m, ray);
    case Shape::kTaperedBox:
      return intersect_tapered(p, ray);
    case Shape::kQuad:
      return intersect_quad(p.half_m, ray);
    case Shape::kCylinder:
      return intersect_cylinder(p.half_m, ray);
    case Shape::kTube:
      return intersect_tube(p.half_m, ray);
    case Shape::kEllipsoid:
      return intersect_ellipsoid(p.half_m, ray);
    case Shape::kCapsule:
      return intersect_capsule(p.half_m, ray);
  }
  return to_m;
}

}  // namespace edgesplat::simulate
