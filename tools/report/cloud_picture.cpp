// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/cloud_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgesplat::report {
namespace {

using Rgb = std::array<std::uint8_t, 3>;
constexpr Rgb kBackground = {16, 20, 24};
constexpr double kTail = 0.005;        // share of outliers left out of the extent at each end
constexpr float kPointSize_m = 0.06F;  // drawn size of a point in the oblique view

/// Nearest point wins each pixel.
class Canvas {
 public:
  Canvas(int width, int height)
      : picture_(width, height), depth_(width, height, std::numeric_limits<float>::infinity()) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) std::copy(kBackground.begin(), kBackground.end(), picture_.pixel(x, y));
    }
  }

  /// A square of `size` pixels around (x, y).
  void draw(int x, int y, int size, float depth, const Rgb& colour) {
    const int first = -(size - 1) / 2;
    for (int py = y + first; py < y + first + size; ++py) {
      for (int px = x + first; px < x + first + size; ++px) {
        if (px < 0 || py < 0 || px >= picture_.width_px || py >= picture_.height_px) continue;
        float& nearest = *depth_.pixel(px, py);
        if (depth >= nearest) continue;
        nearest = depth;
        std::copy(colour.begin(), colour.end(), picture_.pixel(px, py));
      }
    }
  }
  [[nodiscard]] sensor::ImageRgb8 take() { return std::move(picture_); }

 private:
  sensor::ImageRgb8 picture_;
  sensor::ImageF32 depth_;
};

/// Blue over green to yellow.
Rgb height_colour(float share) {
  const float t = std::clamp(share, 0.0F, 1.0F);
  return {static_cast<std::uint8_t>(40.0F + 210.0F * t), static_cast<std::uint8_t>(90.0F + 140.0F * t),
          static_cast<std::uint8_t>(190.0F - 130.0F * t)};
}

Rgb colour_of(const io::PointCloud& cloud, std::size_t i, const Eigen::AlignedBox3f& extent) {
  if (!cloud.rgb.empty()) return cloud.rgb[i];
  return height_colour((cloud.points_m[i].z() - extent.min().z()) / std::max(extent.sizes().z(), 1e-3F));
}

bool is_shown(const Eigen::Vector3f& point, const Eigen::AlignedBox3f& extent, CutAbove cut) {
  return point.z() <= cut.z_m && (point.array() >= extent.min().array()).head<2>().all() &&
         (point.array() <= extent.max().array()).head<2>().all();
}

struct ObliqueCamera {
  Eigen::Vector3f eye;
  Eigen::Vector3f forward;
  Eigen::Vector3f right;
  Eigen::Vector3f down;
  float focal_px = 0.0F;
};

/// Looks across the shorter side, so that a long map lies along the picture, from where all of it fits in.
ObliqueCamera place_camera(const Eigen::AlignedBox3f& extent, CutAbove cut, int width_px, int height_px) {
  constexpr float kFill = 0.47F;  // of the picture's side, from the middle to the outermost corner
  Eigen::AlignedBox3f shown = extent;
  shown.max().z() = std::max(std::min(shown.max().z(), cut.z_m), shown.min().z());
  const bool long_in_x = shown.sizes().x() >= shown.sizes().y();
  ObliqueCamera camera;
  camera.focal_px = 1.2F * static_cast<float>(width_px);
  camera.forward =
      (long_in_x ? Eigen::Vector3f(0.35F, 0.75F, -0.75F) : Eigen::Vector3f(-0.75F, 0.35F, -0.75F))
          .normalized();
  camera.right = camera.forward.cross(Eigen::Vector3f::UnitZ()).normalized();
  camera.down = camera.forward.cross(camera.right);
  float distance_m = 1.0F;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f offset =
        shown.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner)) - shown.center();
    const float across =
        std::abs(offset.dot(camera.right)) * camera.focal_px / (kFill * static_cast<float>(width_px));
    const float along =
        std::abs(offset.dot(camera.down)) * camera.focal_px / (kFill * static_cast<float>(height_px));
    distance_m = std::max(distance_m, std::max(across, along) - offset.dot(camera.forward));
  }
  camera.eye = shown.center() - distance_m * camera.forward;
  return camera;
}

}  // namespace

Eigen::AlignedBox3f core_extent(const io::PointCloud& cloud) {
  Eigen::AlignedBox3f extent;
  if (cloud.points_m.empty()) return extent;
  std::vector<float> values(cloud.points_m.size());
  const auto tail = static_cast<std::ptrdiff_t>(kTail * static_cast<double>(values.size()));
  Eigen::Vector3f low;
  Eigen::Vector3f high;
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(cloud.points_m.begin(), cloud.points_m.end(), values.begin(),
                   [axis](const Eigen::Vector3f& point) { return point[axis]; });
    std::nth_element(values.begin(), values.begin() + tail, values.end());
    low[axis] = values[static_cast<std::size_t>(tail)];
    std::nth_element(values.begin(), values.end() - 1 - tail, values.end());
    high[axis] = values[values.size() - 1 - static_cast<std::size_t>(tail)];
  }
  return {low, high};
}

TopView draw_top_view(const io::PointCloud& cloud, CutAbove cut, int longest_px) {
  const Eigen::AlignedBox3f extent = core_extent(cloud);
  if (extent.isEmpty()) return {};
  const Eigen::Vector2f size_m = extent.sizes().head<2>().cwiseMax(1.0F);
  const float px_per_m = static_cast<float>(longest_px) / size_m.maxCoeff();
  const int width = std::max(static_cast<int>(std::ceil(size_m.x() * px_per_m)), 1);
  const int height = std::max(static_cast<int>(std::ceil(size_m.y() * px_per_m)), 1);
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const int point_px = cloud.points_m.size() < pixels ? 2 : 1;  // sparse maps would look like dust
  Canvas canvas(width, height);
  for (std::size_t i = 0; i < cloud.points_m.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points_m[i];
    if (!is_shown(p, extent, cut)) continue;
    const int x = std::min(static_cast<int>((p.x() - extent.min().x()) * px_per_m), width - 1);
    const int y = std::max(height - 1 - static_cast<int>((p.y() - extent.min().y()) * px_per_m), 0);
    canvas.draw(x, y, point_px, -p.z(), colour_of(cloud, i, extent));
  }
  TopView view{canvas.take(), extent.min().x(), 0.0, extent.min().y(), 0.0};
  view.x_max_m = view.x_min_m + static_cast<double>(width) / static_cast<double>(px_per_m);
  view.y_max_m = view.y_min_m + static_cast<double>(height) / static_cast<double>(px_per_m);
  return view;
}

sensor::ImageRgb8 draw_oblique_view(const io::PointCloud& cloud, CutAbove cut, int width_px, int height_px) {
  Canvas canvas(width_px, height_px);
  const Eigen::AlignedBox3f extent = core_extent(cloud);
  if (extent.isEmpty()) return canvas.take();
  const ObliqueCamera camera = place_camera(extent, cut, width_px, height_px);
  for (std::size_t i = 0; i < cloud.points_m.size(); ++i) {
    if (!is_shown(cloud.points_m[i], extent, cut)) continue;
    const Eigen::Vector3f from_eye = cloud.points_m[i] - camera.eye;
    const float depth = from_eye.dot(camera.forward);
    if (depth < 0.3F) continue;
    const float scale = camera.focal_px / depth;
    const float x = 0.5F * static_cast<float>(width_px) + scale * from_eye.dot(camera.right);
    const float y = 0.5F * static_cast<float>(height_px) + scale * from_eye.dot(camera.down);
    if (std::abs(x) > 1e6F || std::abs(y) > 1e6F) continue;
    const int size_px = std::clamp(static_cast<int>(std::lround(kPointSize_m * scale)), 1, 5);
    canvas.draw(static_cast<int>(x), static_cast<int>(y), size_px, depth, colour_of(cloud, i, extent));
  }
  return canvas.take();
}

}  // namespace edgesplat::report
