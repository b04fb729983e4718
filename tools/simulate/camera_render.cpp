// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/camera_render.hpp"
#include "common/thread/parallel_for.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Below this cosine between ray and normal a pixel covers a long stretch of the surface and gets four rays.
constexpr double kGrazing = 0.35;
/// A texture is never averaged over more than this many pixel widths along the slope.
constexpr double kLongestFootprint = 5.0;
constexpr float kShadeEdge = 0.08F;  ///< jump of the movers' shadow between pixels
constexpr double kDepthEdge = 0.03;  ///< relative jump of range within one surface number
constexpr std::array<std::array<double, 2>, 4> kSubpixels{
    {{-0.25, -0.25}, {0.25, -0.25}, {-0.25, 0.25}, {0.25, 0.25}}};

/// What one ray brings, with and without movers.
struct Sample {
  Vector3f full = Vector3f::Zero();
  Vector3f clean = Vector3f::Zero();
};

class Painter {
 public:
  Painter(const World& world, const CameraView& view)
      : world_(world),
        view_(view),
        rotation_(view.world_from_camera.rotation.toRotationMatrix()),
        width_(view.camera.width_px),
        height_(view.camera.height_px),
        directions_(count()),
        hits_(count()),
        shades_(count(), 1.0F) {}

  CameraPicture paint() {
    CameraPicture picture;
    picture.full = sensor::ImageRgbF32(width_, height_);
    picture.clean = sensor::ImageRgbF32(width_, height_);
    picture.movers = sensor::ImageGray8(width_, height_);
    picture.depth = sensor::ImageF32(width_, height_);
    for_each_row([&](int y) { look(y, picture); });
    for_each_row([&](int y) { shade(y, picture); });
    return picture;
  }

 private:
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  template <typename Row>
  void for_each_row(const Row& row) const {
    thread::parallel_for(0, height_, row);
  }
  [[nodiscard]] Ray ray(const Vector3d& direction_in_camera) const {
    return {view_.world_from_camera.translation_m, rotation_ * direction_in_camera, view_.time_s};
  }

  /// First pass: what each pixel's centre shows.
  void look(int y, CameraPicture& picture) {
    for (int x = 0; x < width_; ++x) {
      Vector3d& direction = directions_[index(x, y)];
      direction = view_.camera.unproject({x, y});
      const std::optional<Hit> hit = world_.cast(ray(direction), Visibility::kEverything);
      hits_[index(x, y)] = hit;
      if (!hit) continue;
      shades_[index(x, y)] = world_.mover_shade(ray(direction), *hit);
      *picture.depth.pixel(x, y) = static_cast<float>(hit->range_m * direction.z());
      *picture.movers.pixel(x, y) = static_cast<std::uint8_t>(std::min<int>(hit->mover, 255));
    }
  }

  /// Second pass: one ray where a surface fills the pixel, else four.
  void shade(int y, CameraPicture& picture) const {
    for (int x = 0; x < width_; ++x) {
      const std::optional<Hit>& hit = hits_[index(x, y)];
      Sample pixel;
      if (!needs_more(x, y)) {
        pixel = still_sample(ray(directions_[index(x, y)]), hit, {pitch(x, y), shades_[index(x, y)]});
      } else {
        for (const auto& [dx, dy] : kSubpixels) {
          const Vector3d direction =
              (directions_[index(x, y)] + dx * slope(x, y, 1, 0) + dy * slope(x, y, 0, 1)).normalized();
          const Ray part = ray(direction);
          const Sample s = sample(part, world_.cast(part, Visibility::kEverything), 0.5 * pitch(x, y));
          pixel.full += 0.25F * s.full;
          pixel.clean += 0.25F * s.clean;
        }
      }
      Eigen::Map<Vector3f>(picture.full.pixel(x, y)) = pixel.full;
      Eigen::Map<Vector3f>(picture.clean.pixel(x, y)) = pixel.clean;
    }
  }

  [[nodiscard]] Sample sample(const Ray& ray, const std::optional<Hit>& hit, double pitch_rad) const {
    Sample s;
    if (hit && hit->mover != 0) {
      s.full = world_.radiance(ray, hit, footprint_m(ray, *hit, pitch_rad), Visibility::kEverything);
      const std::optional<Hit> behind = world_.cast(ray, Visibility::kStaticOnly);
      const double width_m = behind ? footprint_m(ray, *behind, pitch_rad) : 0.0;
      s.clean = world_.radiance(ray, behind, width_m, Visibility::kStaticOnly);
      return s;
    }
    return still_sample(ray, hit, {pitch_rad, hit ? world_.mover_shade(ray, *hit) : 1.0F});
  }

  struct StillPoint {
    double pitch_rad;
    float shade;  ///< light that movers leave
  };
  [[nodiscard]] Sample still_sample(const Ray& ray, const std::optional<Hit>& hit,
                                    const StillPoint& at) const {
    Sample s;
    const double width_m = hit ? footprint_m(ray, *hit, at.pitch_rad) : 0.0;
    s.clean = world_.radiance(ray, hit, width_m, Visibility::kStaticOnly);
    s.full = s.clean * at.shade;
    return s;
  }

  static double footprint_m(const Ray& ray, const Hit& hit, double pitch_rad) {
    const double facing = std::abs(hit.normal.dot(ray.direction));
    return hit.range_m * pitch_rad / std::max(facing, 1.0 / kLongestFootprint);
  }

  /// Change of the direction from one pixel to the next.
  [[nodiscard]] Vector3d slope(int x, int y, int right, int down) const {
    const int x0 = std::max(x - right, 0), x1 = std::min(x + right, width_ - 1);
    const int y0 = std::max(y - down, 0), y1 = std::min(y + down, height_ - 1);
    const int steps = std::max(1, (x1 - x0) + (y1 - y0));
    return (directions_[index(x1, y1)] - directions_[index(x0, y0)]) / steps;
  }
  [[nodiscard]] double pitch(int x, int y) const {
    return 0.5 * (slope(x, y, 1, 0).norm() + slope(x, y, 0, 1).norm());
  }

  [[nodiscard]] bool needs_more(int x, int y) const {
    const std::optional<Hit>& here = hits_[index(x, y)];
    if (here &&
        (here->mover != 0 || std::abs(here->normal.dot(rotation_ * directions_[index(x, y)])) < kGrazing))
      return true;
    const float shade = shades_[index(x, y)];
    return differs(here, shade, x - 1, y) || differs(here, shade, x + 1, y) ||
           differs(here, shade, x, y - 1) || differs(here, shade, x, y + 1);
  }
  [[nodiscard]] bool differs(const std::optional<Hit>& here, float shade_here, int x, int y) const {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return false;
    const std::optional<Hit>& there = hits_[index(x, y)];
    if (here.has_value() != there.has_value()) return true;
    if (!here) return false;
    if (std::abs(shades_[index(x, y)] - shade_here) > kShadeEdge) return true;
    return here->surface != there->surface || here->mover != there->mover ||
           std::abs(here->range_m - there->range_m) >
               kDepthEdge * here->range_m + 0.3 * (here->range_m > 8.0);
  }

  const World& world_;
  const CameraView& view_;
  Eigen::Matrix3d rotation_;
  int width_;
  int height_;
  std::vector<Vector3d> directions_;  ///< of the pixels' centres, camera frame
  std::vector<std::optional<Hit>> hits_;
  std::vector<float> shades_;  ///< light that movers leave at the pixels' centres
};

}  // namespace

CameraPicture render_picture(const World& world, const CameraView& view) {
  const std::unique_ptr<const World> frozen = world.frozen_at(view.time_s);
  return Painter(frozen ? *frozen : world, view).paint();
}

}  // namespace edgesplat::simulate
