// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/reference/splat_reference.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

namespace edgesplat::test {
namespace {

/// Real spherical harmonics up to degree 3 from associated Legendre functions with the Condon-Shortley phase,
/// order m = -l..l: the definition, not the usual table of polynomials.
std::array<double, 16> spherical_harmonics(const Eigen::Vector3d& d) {
  const double phi = std::atan2(d.y(), d.x());
  std::array<double, 16> out{};
  std::size_t k = 0;
  for (int l = 0; l <= 3; ++l) {
    for (int m = -l; m <= l; ++m) {
      const int a = std::abs(m);
      double ratio = 1.0;  // (l - a)! / (l + a)!
      for (int i = l - a + 1; i <= l + a; ++i) ratio /= i;
      const double norm = std::sqrt((2.0 * l + 1.0) / (4.0 * std::numbers::pi) * ratio);
      // std::assoc_legendre leaves the phase (-1)^m out.
      const double phase = a % 2 == 0 ? 1.0 : -1.0;
      const double legendre =
          phase * std::assoc_legendre(static_cast<unsigned>(l), static_cast<unsigned>(a), d.z());
      double angular = 1.0;
      if (m > 0) angular = std::numbers::sqrt2 * std::cos(a * phi);
      if (m < 0) angular = std::numbers::sqrt2 * std::sin(a * phi);
      out[k++] = norm * legendre * angular;
    }
  }
  return out;
}

Eigen::Vector3d colour_of(const ReferenceCloud& cloud, std::size_t row, const Eigen::Vector3d& direction) {
  const std::array<double, 16> basis = spherical_harmonics(direction);
  const std::size_t floats = cloud.sh.size() / cloud.size();
  Eigen::Vector3d rgb = Eigen::Vector3d::Constant(0.5);
  for (std::size_t k = 0; k < floats / 3; ++k)
    for (int c = 0; c < 3; ++c)
      rgb[c] += basis[k] * cloud.sh[row * floats + 3 * k + static_cast<std::size_t>(c)];
  return rgb.cwiseMax(0.0);
}

/// d(pixel)/d(point), 3DGS's clamp for the pinhole, central differences for the fisheye.
Eigen::Matrix<double, 2, 3> jacobian_of(const geometry::CameraModel& camera, const Eigen::Vector3d& p) {
  Eigen::Matrix<double, 2, 3> J;
  if (camera.kind == geometry::CameraKind::kFisheye) {
    const double step = 1e-5 * p.norm();
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(axis);
      J.col(axis) = (*camera.project(p + d) - *camera.project(p - d)) / (2.0 * step);
    }
    return J;
  }
  const double x_limit = 1.3 * 0.5 * camera.width_px / camera.fx_px;
  const double y_limit = 1.3 * 0.5 * camera.height_px / camera.fy_px;
  const double x = std::clamp(p.x() / p.z(), -x_limit, x_limit);
  const double y = std::clamp(p.y() / p.z(), -y_limit, y_limit);
  J << camera.fx_px / p.z(), 0.0, -camera.fx_px * x / p.z(), 0.0, camera.fy_px / p.z(),
      -camera.fy_px * y / p.z();
  return J;
}

/// The draw that decides who stands for others: a hash of the mean in single precision.
double reference_lot(const Eigen::Vector3d& mean) {
  const std::uint32_t multipliers[3] = {0x9E3779B1U, 0x85EBCA77U, 0xC2B2AE3DU};
  const int shifts[3] = {15, 13, 16};
  std::uint32_t hash = 0;
  for (int k = 0; k < 3; ++k) {
    hash = (hash + std::bit_cast<std::uint32_t>(static_cast<float>(mean[k]))) * multipliers[k];
    hash ^= hash >> shifts[k];
  }
  return (hash >> 8U) / 16777216.0;
}

std::optional<ReferenceSplat> splat_of(const ReferenceCloud& cloud, std::size_t row,
                                       const geometry::CameraModel& camera,
                                       const geometry::RigidTransform& camera_from_map,
                                       const ReferenceOptions& options) {
  const Eigen::Vector3d mean = Eigen::Vector3d(&cloud.means_m[3 * row]);
  const Eigen::Vector3d p = camera_from_map * mean;
  const bool fisheye = camera.kind == geometry::CameraKind::kFisheye;
  const double depth_m = fisheye ? p.norm() : p.z();
  if (depth_m <= options.near_m) return std::nullopt;
  if (fisheye && std::atan2(p.head<2>().norm(), p.z()) > 1.9) return std::nullopt;  // as the kernels have it
  const double* q = &cloud.quats_xyzw[4 * row];
  const Eigen::Matrix3d R = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
  Eigen::Vector3d scale = Eigen::Vector3d(&cloud.log_scales[3 * row]).array().exp();
  if (options.least_axis_px > 0.0) {
    const double axis_px = std::max(camera.fx_px, camera.fy_px) * scale.maxCoeff() / depth_m;
    const double size = std::min(1.0, axis_px / options.least_axis_px);
    if (reference_lot(mean) >= size * size) return std::nullopt;
    scale /= size;
  }
  const Eigen::Matrix3d sigma = R * scale.cwiseAbs2().asDiagonal() * R.transpose();
  const Eigen::Matrix<double, 2, 3> J = jacobian_of(camera, p);
  const Eigen::Matrix3d W = camera_from_map.rotation.toRotationMatrix();
  ReferenceSplat splat;
  const Eigen::Matrix2d own_px2 = J * W * sigma * W.transpose() * J.transpose();
  splat.covariance_px2 = own_px2 + options.low_pass_px2 * Eigen::Matrix2d::Identity();
  splat.centre_px = fisheye ? *camera.project(p)
                            : Eigen::Vector2d(camera.fx_px * p.x() / p.z() + camera.cx_px,
                                              camera.fy_px * p.y() / p.z() + camera.cy_px);
  splat.rgb = colour_of(cloud, row, (mean - camera_from_map.inverse().translation_m).normalized());
  splat.opacity = 1.0 / (1.0 + std::exp(-cloud.opacity_logits[row]));
  if (options.antialiased)
    splat.opacity *= std::sqrt(std::max(own_px2.determinant(), 0.0) / splat.covariance_px2.determinant());
  splat.depth_m = depth_m;
  splat.row = row;
  return splat;
}

}  // namespace

ReferenceCloud::ReferenceCloud(const gaussian::GaussianCloud& cloud)
    : sh_degree(cloud.sh_degree),
      means_m(cloud.means_m.begin(), cloud.means_m.end()),
      log_scales(cloud.log_scales.begin(), cloud.log_scales.end()),
      quats_xyzw(cloud.quats_xyzw.begin(), cloud.quats_xyzw.end()),
      opacity_logits(cloud.opacity_logits.begin(), cloud.opacity_logits.end()),
      sh(cloud.sh.begin(), cloud.sh.end()) {}

std::vector<ReferenceSplat> reference_splats(const ReferenceCloud& cloud, const geometry::CameraModel& camera,
                                             const geometry::RigidTransform& camera_from_map,
                                             const ReferenceOptions& options) {
  std::vector<ReferenceSplat> splats;
  for (std::size_t row = 0; row < cloud.size(); ++row)
    if (auto splat = splat_of(cloud, row, camera, camera_from_map, options)) splats.push_back(*splat);
  std::stable_sort(splats.begin(), splats.end(),
                   [](const ReferenceSplat& a, const ReferenceSplat& b) { return a.depth_m < b.depth_m; });
  return splats;
}

ReferencePicture reference_render(const ReferenceCloud& cloud, const geometry::CameraModel& camera,
                                  const geometry::RigidTransform& camera_from_map,
                                  const ReferenceOptions& options) {
  const auto splats = reference_splats(cloud, camera, camera_from_map, options);
  std::vector<Eigen::Matrix2d> inverses;
  inverses.reserve(splats.size());
  for (const ReferenceSplat& splat : splats) inverses.push_back(splat.covariance_px2.inverse());
  ReferencePicture picture;
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      Eigen::Vector3d colour = Eigen::Vector3d::Zero();
      double depth_m = 0.0;
      double transmittance = 1.0;
      for (std::size_t i = 0; i < splats.size(); ++i) {
        const Eigen::Vector2d d = Eigen::Vector2d(x, y) - splats[i].centre_px;
        const double alpha = std::min(0.99, splats[i].opacity * std::exp(-0.5 * d.dot(inverses[i] * d)));
        if (alpha < 1.0 / 255.0) continue;
        if (transmittance * (1.0 - alpha) < 1e-4) break;
        colour += transmittance * alpha * splats[i].rgb;
        depth_m += transmittance * alpha * splats[i].depth_m;
        transmittance *= 1.0 - alpha;
      }
      picture.colour.emplace_back(colour + transmittance * options.background);
      picture.depth_sum_m.push_back(depth_m);
      picture.alpha.push_back(1.0 - transmittance);
    }
  }
  return picture;
}

}  // namespace edgesplat::test
