// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/visual_geometry.hpp"

#include <Eigen/LU>

#include <cmath>

namespace edgesplat::tracking {
namespace {

/// Larger changes of size than a factor 3 either way, or of side than 53 degrees, are not compared.
constexpr double kMaxZoom = 1.6;  // log2
constexpr double kMinCosine = 0.6;
/// Up to this strangeness an observation is as good as any.
constexpr double kAlike = 0.6;
/// From this strangeness on a view is worth an observation of its own.
constexpr double kStrange = 0.8;

/// How differently an observation and a view see a point: doublings of its size plus turns of 30 degrees.
/// Nothing beyond comparing.
struct Comparison {
  double strangeness;
  Eigen::Matrix2d warp;
  Eigen::Vector2d growth;
};

std::optional<Comparison> compare(const VisualObservation& observation, const VisualPoint& point,
                                  const PointInView& seen, const Eigen::Vector3d& camera_in_odom_m) {
  Comparison result;
  Eigen::Matrix<double, 3, 2> step_m;
  step_m << observation.right_m.cast<double>(), observation.down_m.cast<double>();
  result.warp = seen.pixel_by_odom * step_m;
  result.growth =
      step_m.transpose() * seen.forward / seen.p_in_camera_m.z() - observation.growth.cast<double>();
  const double area = result.warp.determinant();
  if (!(area > 1e-3)) return std::nullopt;  // also where the plane is seen from behind
  const double zoom = std::abs(0.5 * std::log2(area));
  const Eigen::Vector3d from_camera = point.p_in_odom_m - camera_in_odom_m;
  const Eigen::Vector3d before = observation.from_camera_m.cast<double>();
  const double cosine = from_camera.dot(before) / (from_camera.norm() * before.norm());
  if (zoom > kMaxZoom || cosine < kMinCosine) return std::nullopt;
  constexpr double kCosineOf30 = 0.866;
  result.strangeness = zoom + (1.0 - cosine) / (1.0 - kCosineOf30);
  return result;
}

}  // namespace

std::optional<PointInView> look_at(const CameraView& view, const Eigen::Vector3d& p_in_odom_m) {
  PointInView seen;
  seen.p_in_camera_m = view.camera_from_odom * p_in_odom_m;
  if (!(seen.p_in_camera_m.z() > 0.05)) return std::nullopt;
  const auto pixel = view.camera.project(seen.p_in_camera_m);
  if (!pixel) return std::nullopt;
  seen.pixel = *pixel;
  // By differences, whatever the lens: the error is of the order of the step squared.
  const double step = 1e-4 * seen.p_in_camera_m.z();
  Eigen::Matrix<double, 2, 3> by_camera;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d nudge = step * Eigen::Vector3d::Unit(axis);
    const auto more = view.camera.project(seen.p_in_camera_m + nudge);
    const auto less = view.camera.project(seen.p_in_camera_m - nudge);
    if (!more || !less) return std::nullopt;
    by_camera.col(axis) = (*more - *less) / (2.0 * step);
  }
  const Eigen::Matrix3d rotation = view.camera_from_odom.rotation.toRotationMatrix();
  seen.forward = rotation.row(2);
  seen.pixel_by_odom = by_camera * rotation;
  return seen;
}

std::optional<Reference> choose_reference(const VisualMap& map, const VisualPoint& point,
                                          const PointInView& seen, const Eigen::Vector3d& camera_in_odom_m) {
  std::optional<Reference> best;
  double least = 0.0;
  for (std::size_t i = 0; i < point.observation_count; ++i) {
    const std::uint32_t index = point.observations[i];
    const auto comparison = compare(map.observation(index), point, seen, camera_in_odom_m);
    if (!comparison || (best && comparison->strangeness >= least)) continue;
    best = Reference{index, comparison->warp, comparison->growth};
    least = comparison->strangeness;
    if (least < kAlike) break;
  }
  return best;
}

bool is_new_view(const VisualMap& map, const VisualPoint& point, const PointInView& seen,
                 const Eigen::Vector3d& camera_in_odom_m) {
  for (std::size_t i = 0; i < point.observation_count; ++i) {
    const auto comparison = compare(map.observation(point.observations[i]), point, seen, camera_in_odom_m);
    if (comparison && comparison->strangeness < kStrange) return false;
  }
  return true;
}

}  // namespace edgesplat::tracking
