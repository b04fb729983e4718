// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/moving.hpp"

#include "kernels/mapping/pixel_points.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::mapping {
namespace {

constexpr float kNearest_m = 0.1F;
constexpr float kLeastMark_px = 3.0F;
constexpr float kMostMark_px = 32.0F;

Eigen::Vector3f in_camera(const SparseDepth& d, const geometry::CameraModel& camera) {
  const auto width = static_cast<std::uint32_t>(camera.width_px);
  return d.depth_m * ray_of(camera, static_cast<int>(d.pixel % width), static_cast<int>(d.pixel / width));
}

}  // namespace

std::vector<SparseDepth> moving_depths(const StoredView& view, const DepthPicture& other,
                                       const LookThrough& by) {
  std::vector<SparseDepth> moving;
  for (const SparseDepth& d : view.depths) {
    const Eigen::Vector3d p_in_map_m = view.map_from_camera * in_camera(d, view.camera()).cast<double>();
    if (other.looks_through(p_in_map_m.cast<float>(), by)) moving.push_back(d);
  }
  return moving;
}

MovingMask::MovingMask(const StoredView& view)
    : map_from_camera_(view.map_from_camera),
      camera_(view.camera()),
      projector_(view.map_from_camera.inverse(), view.camera()) {}

void MovingMask::mark(const SparseDepth& measured, const GroundPlane* floor, const MovingOptions& options) {
  const Eigen::Vector3f p = in_camera(measured, camera_);
  Eigen::Vector3f down = Eigen::Vector3f::Zero();  // from the measurement to the floor
  if (floor != nullptr) {
    const Eigen::Vector3d p_in_map_m = map_from_camera_ * p.cast<double>();
    const double height_m = floor->normal.dot(p_in_map_m) - floor->offset_m;
    if (height_m > 0.0 && height_m < static_cast<double>(options.tallest_m))
      down = (map_from_camera_.rotation.conjugate() * (-height_m * floor->normal)).cast<float>();
  }
  const int steps = 1 + static_cast<int>(down.norm() / options.radius_m);
  for (int i = 0; i <= steps; ++i)
    mark_around(p + (static_cast<float>(i) / static_cast<float>(steps)) * down, options.radius_m);
}

void MovingMask::mark(const Eigen::Vector3f& p_in_map_m, float radius_m) {
  mark_around((map_from_camera_.inverse() * p_in_map_m.cast<double>()).cast<float>(), radius_m);
}

void MovingMask::mark_around(const Eigen::Vector3f& p_in_camera_m, float radius_m) {
  const float depth_m = p_in_camera_m.z();
  if (!(depth_m > kNearest_m)) return;
  const auto fx_px = static_cast<float>(camera_.fx_px);
  const float u = fx_px * p_in_camera_m.x() / depth_m + static_cast<float>(camera_.cx_px);
  const float v =
      static_cast<float>(camera_.fy_px) * p_in_camera_m.y() / depth_m + static_cast<float>(camera_.cy_px);
  const float reach_px = std::clamp(radius_m * fx_px / depth_m, kLeastMark_px, kMostMark_px);
  const auto width = static_cast<float>(camera_.width_px);
  const auto height = static_cast<float>(camera_.height_px);
  if (!(u > -reach_px && v > -reach_px && u < width + reach_px && v < height + reach_px)) return;
  if (depth_m_.empty())
    depth_m_.resize(static_cast<std::size_t>(camera_.width_px) * static_cast<std::size_t>(camera_.height_px),
                    0.0F);
  const auto from = [&](float at) { return std::max(0, static_cast<int>(std::ceil(at - reach_px))); };
  const auto to = [&](float at, int size) { return std::min(size - 1, static_cast<int>(at + reach_px)); };
  for (int y = from(v); y <= to(v, camera_.height_px); ++y) {
    for (int x = from(u); x <= to(u, camera_.width_px); ++x) {
      float& depth = depth_m_[static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width_px) +
                              static_cast<std::size_t>(x)];
      if (depth == 0.0F || depth_m < depth) depth = depth_m;
    }
  }
}

std::optional<float> MovingMask::behind_m(const Eigen::Vector3f& p_in_map_m) const {
  if (depth_m_.empty()) return std::nullopt;
  const auto hit = projector_.project(p_in_map_m, kNearest_m);
  if (!hit) return std::nullopt;
  const float depth = depth_m_[static_cast<std::size_t>(hit->y) * static_cast<std::size_t>(camera_.width_px) +
                               static_cast<std::size_t>(hit->x)];
  if (depth == 0.0F) return std::nullopt;
  return hit->depth_m - depth;
}

bool MovingMask::holds(const Eigen::Vector3f& p_in_map_m, float thickness_m) const {
  const auto behind = behind_m(p_in_map_m);
  return behind && std::abs(*behind) < thickness_m;
}

bool MovingMask::hides(const Eigen::Vector3f& p_in_map_m, float thickness_m) const {
  const auto behind = behind_m(p_in_map_m);
  return behind && *behind > -thickness_m;
}

void MovingMask::hide_in(StoredView& view) const {
  if (depth_m_.empty()) return;
  if (view.ignored.empty()) view.ignored.resize(depth_m_.size(), false);
  for (std::size_t pixel = 0; pixel < depth_m_.size(); ++pixel) {
    if (depth_m_[pixel] > 0.0F) view.ignored[pixel] = true;
  }
}

}  // namespace edgesplat::mapping
