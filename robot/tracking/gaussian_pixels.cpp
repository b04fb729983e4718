// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/gaussian_pixels.hpp"

#include "common/geometry/so3.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::tracking {
namespace {

/// The map fills a pixel from here on.
constexpr float kFullAlpha = 0.9F;
/// Depths of neighbours differing by more than this share: an edge.
constexpr float kEdgeShare = 0.15F;
/// Slopes smaller than this (grey levels a pixel) tell less than noise and paint do.
constexpr float kLeastSlope = 3.0F;
constexpr std::size_t kMostPixels = 6000;
constexpr std::size_t kMostSurface = 1500;

/// The point behind a pixel.
Eigen::Vector3f behind(const geometry::CameraModel& camera, float x, float y, float depth_m) {
  return depth_m * Eigen::Vector3f((x - static_cast<float>(camera.cx_px)) / static_cast<float>(camera.fx_px),
                                   (y - static_cast<float>(camera.cy_px)) / static_cast<float>(camera.fy_px),
                                   1.0F);
}

/// True where the pixel and its neighbours have depths of one surface; not at the picture's edge.
bool on_one_surface(const sensor::ImageF32& depth_m, int x, int y) {
  float least = *depth_m.pixel(x, y), most = least;
  for (int dy = -1; dy <= 1; ++dy) {
    const float* row = depth_m.pixel(x - 1, y + dy);
    for (int dx = 0; dx < 3; ++dx) {
      least = std::min(least, row[dx]);
      most = std::max(most, row[dx]);
    }
  }
  return least > 0.0F && most - least < kEdgeShare * least;
}

/// Towards the camera. The pixel must be on_one_surface().
Eigen::Vector3f normal_at(const geometry::CameraModel& camera, const sensor::ImageF32& depth_m, int x,
                          int y) {
  const auto at = [&](int dx, int dy) {
    return behind(camera, static_cast<float>(x + dx), static_cast<float>(y + dy),
                  *depth_m.pixel(x + dx, y + dy));
  };
  const Eigen::Vector3f normal = (at(0, 1) - at(0, -1)).cross(at(1, 0) - at(-1, 0));
  return normal.normalized();
}

/// Every n-th, so that at most `most` are left.
template <typename T>
void thin(std::vector<T>& items, std::size_t most) {
  if (items.size() <= most) return;
  for (std::size_t i = 0; i < most; ++i) items[i] = items[i * items.size() / most];
  items.resize(most);
}

}  // namespace

Eigen::Matrix<float, 6, 1> value_by_pose(const Eigen::Vector3f& p, const Eigen::Vector2f& slope,
                                         const DrawnFrom& from) {
  const auto fx = static_cast<float>(from.camera.fx_px), fy = static_cast<float>(from.camera.fy_px);
  const float z = p.z();
  const Eigen::Vector3f by_camera(slope.x() * fx / z, slope.y() * fy / z,
                                  -(slope.x() * fx * p.x() + slope.y() * fy * p.y()) / (z * z));
  // p_in_camera = camera_from_body (R'(p_in_odom - t)): R' turns by -dr, t moves by dt.
  const Eigen::Vector3d by_body = from.body_from_camera.rotation * by_camera.cast<double>();
  const Eigen::Vector3d in_body = from.body_from_camera * p.cast<double>();
  Eigen::Matrix<float, 6, 1> by_pose;
  by_pose.head<3>() = by_body.cross(in_body).cast<float>();
  by_pose.tail<3>() = -(from.odom_from_body.rotation * by_body).cast<float>();
  return by_pose;
}

// The mean of the inverse depths, which go linearly over a plane; nothing where one of them is missing.
void GaussianPixelChooser::halve_depth(int level) {
  const sensor::ImageF32& fine = depth_m_[static_cast<std::size_t>(level - 1)];
  sensor::ImageF32& half = depth_m_[static_cast<std::size_t>(level)];
  half = sensor::ImageF32(fine.width_px / 2, fine.height_px / 2);
  for (int y = 0; y < half.height_px; ++y) {
    for (int x = 0; x < half.width_px; ++x) {
      const float* upper = fine.pixel(2 * x, 2 * y);
      const float* lower = fine.pixel(2 * x, 2 * y + 1);
      if (std::min({upper[0], upper[1], lower[0], lower[1]}) <= 0.0F) continue;
      *half.pixel(x, y) = 4.0F / (1.0F / upper[0] + 1.0F / upper[1] + 1.0F / lower[0] + 1.0F / lower[1]);
    }
  }
}

void GaussianPixelChooser::choose_level(int level, const DrawnFrom& drawn, const DepthCells& depths,
                                        std::vector<GaussianPixel>& out) const {
  const sensor::ImageGray8& gray = gray_.level(level);
  const sensor::ImageF32& depth_m = depth_m_[static_cast<std::size_t>(level)];
  DrawnFrom from = drawn;
  from.camera = image::halved(drawn.camera, level);
  struct Candidate {
    int x, y;
    Eigen::Vector2f slope;
  };
  std::vector<Candidate> textured;
  for (int y = 1; y + 1 < gray.height_px; ++y) {
    for (int x = 1; x + 1 < gray.width_px; ++x) {
      const Eigen::Vector2f slope(0.5F * static_cast<float>(*gray.pixel(x + 1, y) - *gray.pixel(x - 1, y)),
                                  0.5F * static_cast<float>(*gray.pixel(x, y + 1) - *gray.pixel(x, y - 1)));
      if (slope.squaredNorm() < kLeastSlope * kLeastSlope || !on_one_surface(depth_m, x, y)) continue;
      textured.push_back({x, y, slope});
    }
  }
  thin(textured, kMostPixels);
  out.clear();
  const float size = std::ldexp(1.0F, level);
  for (const Candidate& at : textured) {
    const Eigen::Vector3f p =
        behind(from.camera, static_cast<float>(at.x), static_cast<float>(at.y), *depth_m.pixel(at.x, at.y));
    const Eigen::Vector2f as_drawn((static_cast<float>(at.x) + 0.5F) * size - 0.5F,
                                   (static_cast<float>(at.y) + 0.5F) * size - 0.5F);
    if (!depths.agree({as_drawn, p, normal_at(from.camera, depth_m, at.x, at.y)})) continue;
    out.push_back({p, static_cast<float>(*gray.pixel(at.x, at.y)), value_by_pose(p, at.slope, from)});
  }
}

void GaussianPixelChooser::choose(const GaussianPicture& drawn, const DrawnFrom& from,
                                  const DepthCells& depths, std::span<const Eigen::Vector3f> scan,
                                  GaussianPixels& out) {
  gray_.build(drawn.picture, 0, kGaussianLevels);
  depth_m_[0] = drawn.depth_m;
  std::size_t filled = 0;
  for (std::size_t i = 0; i < depth_m_[0].values.size(); ++i) {
    const bool full = drawn.alpha.values[i] >= kFullAlpha && drawn.depth_m.values[i] > 0.0F;
    filled += full ? 1 : 0;
    if (!full) depth_m_[0].values[i] = 0.0F;
  }
  out.coverage =
      static_cast<double>(filled) / static_cast<double>(std::max<std::size_t>(1, depth_m_[0].values.size()));
  for (int level = 1; level < kGaussianLevels; ++level) halve_depth(level);
  for (int level = 0; level < kGaussianLevels; ++level)
    choose_level(level, from, depths, out.levels[static_cast<std::size_t>(level)]);

  out.surface.clear();
  const geometry::RigidTransform odom_from_camera = from.odom_from_body * from.body_from_camera;
  const geometry::RigidTransform camera_from_body = from.body_from_camera.inverse();
  for (const Eigen::Vector3f& p : scan) {
    const Eigen::Vector3d in_camera = camera_from_body * p.cast<double>();
    const auto pixel = from.camera.project(in_camera);
    if (!pixel || !from.camera.contains(*pixel, 1.0)) continue;
    const auto x = static_cast<int>(std::lround(pixel->x())), y = static_cast<int>(std::lround(pixel->y()));
    if (x < 1 || y < 1 || x + 1 >= depth_m_[0].width_px || y + 1 >= depth_m_[0].height_px) continue;
    if (!on_one_surface(depth_m_[0], x, y)) continue;
    const Eigen::Vector3f there =
        behind(from.camera, static_cast<float>(x), static_cast<float>(y), *depth_m_[0].pixel(x, y));
    const Eigen::Vector3f normal = normal_at(from.camera, depth_m_[0], x, y);
    out.surface.push_back(
        {p, odom_from_camera * there.cast<double>(), odom_from_camera.rotation * normal.cast<double>()});
  }
  thin(out.surface, kMostSurface);
}

}  // namespace edgesplat::tracking
