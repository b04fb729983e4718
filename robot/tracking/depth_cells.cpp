// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/depth_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgesplat::tracking {
namespace {

constexpr float kCell_px = 8.0F;
constexpr float kReach_px = 7.0F;
/// Points farther than this from a plane are not on it: a base and a share of the distance.
constexpr float kApart_m = 0.08F;
constexpr float kApartShare = 0.01F;
/// A third of the points near a pixel must say so: single returns from edges do not count.
constexpr int kWitnessShare = 3;
/// How far off the mean of all may be.
constexpr float kMeanSigmas = 1.5F;

}  // namespace

void DepthCells::build(std::span<const Eigen::Vector3f> points,
                       const geometry::RigidTransform& camera_from_body,
                       const geometry::CameraModel& camera) {
  columns_ = static_cast<int>(static_cast<float>(camera.width_px) / kCell_px) + 1;
  rows_ = static_cast<int>(static_cast<float>(camera.height_px) / kCell_px) + 1;
  const Eigen::Matrix3f rotation = camera_from_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = camera_from_body.translation_m.cast<float>();
  // A cone that holds the picture with room for distortion: most points are behind or beside the camera.
  const auto wide = static_cast<float>(1.3 * std::hypot(camera.width_px, camera.height_px) /
                                       (2.0 * std::min(camera.fx_px, camera.fy_px)));
  unsorted_.clear();
  cell_of_.clear();
  first_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3f in_camera = rotation * p + translation;
    if (!(in_camera.z() > 0.05F) ||
        in_camera.head<2>().squaredNorm() > wide * wide * in_camera.z() * in_camera.z())
      continue;
    const auto pixel = camera.project(in_camera.cast<double>());
    if (!pixel || !camera.contains(*pixel)) continue;
    const Eigen::Vector2f at = pixel->cast<float>();
    const auto cell =
        static_cast<std::uint32_t>(std::max(at.y(), 0.0F) / kCell_px) * static_cast<std::uint32_t>(columns_) +
        static_cast<std::uint32_t>(std::max(at.x(), 0.0F) / kCell_px);
    unsorted_.push_back({at, in_camera});
    cell_of_.push_back(cell);
    ++first_[cell + 1];
  }
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  seen_.resize(unsorted_.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < unsorted_.size(); ++i) seen_[next[cell_of_[i]]++] = unsorted_[i];
}

template <typename Visit>
void DepthCells::around(const Eigen::Vector2f& pixel, const Visit& visit) const {
  const auto x = static_cast<int>(pixel.x() / kCell_px);
  const auto y = static_cast<int>(pixel.y() / kCell_px);
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, rows_ - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, columns_ - 1); ++column) {
      const auto cell = static_cast<std::size_t>(row * columns_ + column);
      for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
        if ((seen_[i].pixel - pixel).squaredNorm() < kReach_px * kReach_px) visit(seen_[i]);
      }
    }
  }
}

bool DepthCells::agree(const PlaneInView& plane) const {
  int near = 0, apart = 0;
  float sum_m = 0.0F;
  around(plane.pixel, [&](const Seen& seen) {
    const float off = plane.normal_in_camera.dot(seen.p_in_camera_m - plane.p_in_camera_m);
    ++near;
    sum_m += off;
    if (std::abs(off) > kApart_m + kApartShare * seen.p_in_camera_m.z()) ++apart;
  });
  if (apart > 0 && apart * kWitnessShare >= near) return false;
  if (!noise_) return true;
  const float variance_m2 = noise_->variance_along(plane.p_in_camera_m, plane.normal_in_camera);
  return sum_m * sum_m <= kMeanSigmas * kMeanSigmas * static_cast<float>(near) * variance_m2;
}

std::optional<Eigen::Vector3f> DepthCells::nearest(const Eigen::Vector2f& pixel) const {
  std::optional<Eigen::Vector3f> best;
  float least = std::numeric_limits<float>::max();
  around(pixel, [&](const Seen& seen) {
    const float distance = (seen.pixel - pixel).squaredNorm();
    if (distance >= least) return;
    least = distance;
    best = seen.p_in_camera_m;
  });
  return best;
}

}  // namespace edgesplat::tracking
