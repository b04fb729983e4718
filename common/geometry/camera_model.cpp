// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/camera_model.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace edgesplat::geometry {
namespace {

struct Distorted {
  Eigen::Vector2d xy;
  Eigen::Matrix2d jacobian;
};

Distorted distort_radtan(const Eigen::Vector2d& n, const CameraModel& camera) {
  const auto [k1, k2, p1, p2] = camera.distortion;
  const double k3 = camera.k3;
  const double x = n.x(), y = n.y(), r2 = n.squaredNorm();
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = k1 + r2 * (2.0 * k2 + 3.0 * k3 * r2);  // d(radial)/d(r2)
  Distorted out;
  out.xy = {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
  const double cross = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
  out.jacobian << radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, cross, cross,
      radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  return out;
}

/// True where the radius of the picture grows with r2 all the way from the centre. The slope of
/// r (1 + k1 r2 + k2 r2^2 + k3 r2^3) is 1 + 3 k1 s + 5 k2 s^2 + 7 k3 s^3 with s = r2; beyond its first root
/// the polynomial has turned back, even where it grows again further out.
bool before_radtan_fold(double r2, const CameraModel& camera) {
  const double a = 7.0 * camera.k3;
  const double b = 5.0 * camera.distortion[1];
  const double c = 3.0 * camera.distortion[0];
  const auto grows_at = [&](double s) { return 1.0 + s * (c + s * (b + s * a)) > 0.0; };
  if (!grows_at(r2)) return false;
  // Its lowest place before r2: a root of c + 2 b s + 3 a s^2, written so that a = 0 is nothing special.
  const double under_root = b * b - 3.0 * a * c;
  if (under_root <= 0.0) return true;
  const double q = -(b + std::copysign(std::sqrt(under_root), b));
  for (const double s : {q / (3.0 * a), c / q})
    if (s > 0.0 && s < r2 && !grows_at(s)) return false;
  return true;
}

double fisheye_radius(double theta, const std::array<double, 4>& k) {
  const double t2 = theta * theta;
  return theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

double fisheye_slope(double theta, const std::array<double, 4>& k) {
  const double t2 = theta * theta;
  return 1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])));
}

/// The same for the fisheye polynomial, looked at in eight steps: lens polynomials have no narrower folds.
bool before_fisheye_fold(double theta, const std::array<double, 4>& k) {
  constexpr int kSteps = 8;
  for (int i = 1; i <= kSteps; ++i)
    if (fisheye_slope(theta * i / kSteps, k) <= 0.0) return false;
  return true;
}

}  // namespace

Status CameraModel::validate() const {
  const bool finite = std::isfinite(fx_px) && std::isfinite(fy_px) && std::isfinite(cx_px) &&
                      std::isfinite(cy_px) && std::isfinite(distortion[0]) && std::isfinite(distortion[1]) &&
                      std::isfinite(distortion[2]) && std::isfinite(distortion[3]) && std::isfinite(k3);
  if (!finite) return fail(Errc::kInvalidConfig, "camera model: a parameter is not finite");
  if (width_px <= 0 || height_px <= 0)
    return fail(Errc::kInvalidConfig, "camera model: size must be positive");
  if (fx_px <= 0 || fy_px <= 0)
    return fail(Errc::kInvalidConfig, "camera model: focal lengths must be positive");
  return {};
}

std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& p) const {
  if (!p.allFinite()) return std::nullopt;
  Eigen::Vector2d xy;
  if (kind == CameraKind::kPinhole) {
    if (p.z() <= 1e-6) return std::nullopt;
    const Eigen::Vector2d n = p.head<2>() / p.z();
    if (!before_radtan_fold(n.squaredNorm(), *this)) return std::nullopt;
    const Distorted d = distort_radtan(n, *this);
    if (d.jacobian.determinant() <= 0.0) return std::nullopt;  // the tangential terms can fold it, too
    xy = d.xy;
  } else {
    const double r = p.head<2>().norm();
    if (r < 1e-12 && p.z() <= 0.0) return std::nullopt;
    const double theta = std::atan2(r, p.z());
    if (!before_fisheye_fold(theta, distortion)) return std::nullopt;
    const double scale = r < 1e-12 ? 1.0 / p.z() : fisheye_radius(theta, distortion) / r;
    xy = scale * p.head<2>();
  }
  return Eigen::Vector2d(fx_px * xy.x() + cx_px, fy_px * xy.y() + cy_px);
}

Eigen::Vector3d CameraModel::unproject(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d target((pixel.x() - cx_px) / fx_px, (pixel.y() - cy_px) / fy_px);
  if (kind == CameraKind::kPinhole) {
    Eigen::Vector2d n = target;
    for (int i = 0; i < 20; ++i) {
      const Distorted d = distort_radtan(n, *this);
      const Eigen::Vector2d step = d.jacobian.inverse() * (d.xy - target);
      if (!step.allFinite()) break;
      n -= step;
      if (step.squaredNorm() < 1e-24) break;
    }
    return Eigen::Vector3d(n.x(), n.y(), 1.0).normalized();
  }
  const double radius = target.norm();
  if (radius < 1e-12) return Eigen::Vector3d::UnitZ();
  double theta = radius;
  for (int i = 0; i < 20; ++i) {
    const double slope = fisheye_slope(theta, distortion);
    if (slope <= 0.0) break;
    const double step = (fisheye_radius(theta, distortion) - radius) / slope;
    theta -= step;
    if (std::abs(step) < 1e-12) break;
  }
  theta = std::min(std::max(theta, 0.0), std::numbers::pi);
  const Eigen::Vector2d direction = target / radius;
  return {std::sin(theta) * direction.x(), std::sin(theta) * direction.y(), std::cos(theta)};
}

bool CameraModel::contains(const Eigen::Vector2d& pixel, double border_px) const {
  return pixel.x() >= border_px - 0.5 && pixel.y() >= border_px - 0.5 &&
         pixel.x() < width_px - 0.5 - border_px && pixel.y() < height_px - 0.5 - border_px;
}

CameraModel CameraModel::scaled(double factor) const {
  return scaled_to(std::max(1, static_cast<int>(std::lround(width_px * factor))),
                   std::max(1, static_cast<int>(std::lround(height_px * factor))));
}

CameraModel CameraModel::scaled_to(int to_width_px, int to_height_px) const {
  CameraModel out = *this;
  out.width_px = to_width_px;
  out.height_px = to_height_px;
  const double sx = static_cast<double>(out.width_px) / width_px;
  const double sy = static_cast<double>(out.height_px) / height_px;
  out.fx_px *= sx;
  out.fy_px *= sy;
  out.cx_px = (cx_px + 0.5) * sx - 0.5;  // the picture's corner, not the pixel's centre, stays in place
  out.cy_px = (cy_px + 0.5) * sy - 0.5;
  return out;
}

}  // namespace edgesplat::geometry
