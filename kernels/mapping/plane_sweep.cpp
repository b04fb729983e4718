// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/plane_sweep.hpp"

#include "common/thread/parallel_for.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace edgesplat::mapping {
namespace {

constexpr int kNoDepth = -1;
constexpr double kMostTurn_rad = 0.6;  ///< views turned apart farther share too little
constexpr std::size_t kMostNeighbours = 9;

/// Brightness 0..1 of a picture.
class GreyPicture {
 public:
  explicit GreyPicture(const sensor::ImageRgb8& picture)
      : width_(picture.width_px), height_(picture.height_px), grey_(picture.values.size() / 3) {
    for (std::size_t i = 0; i < grey_.size(); ++i) {
      const std::uint8_t* rgb = &picture.values[3 * i];
      grey_[i] = static_cast<float>(rgb[0] + 2 * rgb[1] + rgb[2]) / 1020.0F;
    }
  }
  [[nodiscard]] bool holds(float u, float v) const {
    return u >= 0.0F && v >= 0.0F && u < static_cast<float>(width_ - 1) &&
           v < static_cast<float>(height_ - 1);
  }
  [[nodiscard]] float at(int x, int y) const { return grey_[index(x, y)]; }
  /// Bilinear; inside as of holds().
  [[nodiscard]] float at(float u, float v) const {
    const int x = static_cast<int>(u);
    const int y = static_cast<int>(v);
    const float fx = u - static_cast<float>(x);
    const float fy = v - static_cast<float>(y);
    const float* top = &grey_[index(x, y)];
    const float* bottom = top + width_;
    return (1 - fy) * ((1 - fx) * top[0] + fx * top[1]) + fy * ((1 - fx) * bottom[0] + fx * bottom[1]);
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_, height_;
  std::vector<float> grey_;
};

/// Another view, and where the new view's pixels come to lie in it.
struct Partner {
  GreyPicture picture;
  Eigen::Matrix3f other_from_ray;  ///< pixel in the other <- ray in the new camera, before division
  Eigen::Vector3f other_offset;    ///< ... plus this over the depth
};

Partner partner_of(const StoredView& view, const StoredView& other) {
  const geometry::RigidTransform other_from_view = other.map_from_camera.inverse() * view.map_from_camera;
  Eigen::Matrix3d intrinsics = Eigen::Matrix3d::Identity();
  const geometry::CameraModel& camera = other.camera();
  intrinsics(0, 0) = camera.fx_px;
  intrinsics(1, 1) = camera.fy_px;
  intrinsics(0, 2) = camera.cx_px;
  intrinsics(1, 2) = camera.cy_px;
  return {GreyPicture(other.picture),
          (intrinsics * other_from_view.rotation.toRotationMatrix()).cast<float>(),
          (intrinsics * other_from_view.translation_m).cast<float>()};
}

/// Compares the patch around one pixel with what other views show of it at some depth.
class PatchCompare {
 public:
  PatchCompare(const geometry::CameraModel& camera, int half_px) : camera_(camera), half_px_(half_px) {}

  /// The patch around a pixel, or the nearest one that lies within the picture, which must hold one.
  void take(const GreyPicture& picture, int at_x, int at_y) {
    const int x = std::clamp(at_x, half_px_, camera_.width_px - 1 - half_px_);
    const int y = std::clamp(at_y, half_px_, camera_.height_px - 1 - half_px_);
    own_.clear();
    rays_.clear();
    for (int v = y - half_px_; v <= y + half_px_; ++v) {
      for (int u = x - half_px_; u <= x + half_px_; ++u) {
        own_.push_back(picture.at(u, v));
        rays_.push_back(ray_of(camera_, u, v));
      }
    }
    remove_mean(own_);
  }
  /// Mean over the others that see the whole patch, each as of difference(); infinite where none does.
  float mean_difference(std::span<const Partner> others, float inverse_depth) {
    float sum = 0.0F;
    float count = 0.0F;
    for (const Partner& other : others) {
      const float d = difference(other, inverse_depth);
      if (std::isinf(d)) continue;
      sum += d;
      count += 1.0F;
    }
    return count > 0.0F ? sum / count : std::numeric_limits<float>::infinity();
  }

 private:
  /// Mean absolute difference; infinite where the other does not see the whole patch.
  float difference(const Partner& other, float inverse_depth) {
    seen_.clear();
    for (const Eigen::Vector3f& ray : rays_) {
      const Eigen::Vector3f p = other.other_from_ray * ray + inverse_depth * other.other_offset;
      const float u = p.x() / p.z();
      const float v = p.y() / p.z();
      if (!(p.z() > 0.0F) || !other.picture.holds(u, v)) return std::numeric_limits<float>::infinity();
      seen_.push_back(other.picture.at(u, v));
    }
    remove_mean(seen_);
    float sum = 0.0F;
    for (std::size_t i = 0; i < own_.size(); ++i) sum += std::abs(own_[i] - seen_[i]);
    return sum / static_cast<float>(own_.size());
  }
  static void remove_mean(std::vector<float>& values) {
    float mean = 0.0F;
    for (const float value : values) mean += value;
    mean /= static_cast<float>(values.size());
    for (float& value : values) value -= mean;
  }
  const geometry::CameraModel& camera_;
  int half_px_;
  std::vector<float> own_, seen_;
  std::vector<Eigen::Vector3f> rays_;
};

/// Number of the depth that suits, 0 the farthest; kNoDepth for none.
int choose(std::span<const float> differences, const SweepOptions& options) {
  const float best = *std::min_element(differences.begin(), differences.end());
  if (!(best <= options.max_difference)) return kNoDepth;
  const auto good = std::find_if(differences.begin(), differences.end(),
                                 [&](float d) { return d <= best + options.ambiguous; });
  return static_cast<int>(good - differences.begin());
}

float inverse_depth_of(int number, const SweepOptions& options) {
  const float share = static_cast<float>(number) / static_cast<float>(options.depths - 1);
  return (1.0F - share) / options.farthest_m + share / options.nearest_m;
}

/// The numbers of the depths on the grid of asked pixels.
class NumberGrid {
 public:
  NumberGrid(int columns, int rows)
      : columns_(columns),
        rows_(rows),
        numbers_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), kNoDepth) {}
  [[nodiscard]] int& at(int column, int row) {
    return numbers_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(column)];
  }
  /// Of the neighbours that have a depth, itself too.
  [[nodiscard]] int median_around(int column, int row) {
    std::array<int, kMostNeighbours> around{};
    std::size_t count = 0;
    for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
      for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c) {
        if (at(c, r) != kNoDepth) around[count++] = at(c, r);
      }
    }
    const auto middle = around.begin() + static_cast<std::ptrdiff_t>(count / 2);
    std::nth_element(around.begin(), middle, around.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
  }

 private:
  int columns_, rows_;
  std::vector<int> numbers_;
};

bool asked(const StoredView& view, std::span<const float> alpha, int x, int y, const SweepOptions& options) {
  const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(view.camera().width_px) +
                     static_cast<std::size_t>(x);
  return alpha[pixel] < options.max_alpha && view.undistorter->seen()[pixel] > 0.0F &&
         (view.ignored.empty() || !view.ignored[pixel]);
}

}  // namespace

std::vector<const StoredView*> sweep_partners(const StoredView& view,
                                              std::span<const StoredView* const> newest_first,
                                              const SweepOptions& options) {
  std::vector<const StoredView*> partners;
  for (const StoredView* other : newest_first) {
    if (partners.size() == options.views) break;
    const double apart_m = (other->map_from_camera.translation_m - view.map_from_camera.translation_m).norm();
    const double turned_rad = other->map_from_camera.rotation.angularDistance(view.map_from_camera.rotation);
    // Each next one farther away, as a longer baseline tells far depths apart.
    const double least_m =
        static_cast<double>(options.baseline_m) * static_cast<double>(std::size_t{1} << partners.size());
    if (apart_m >= least_m && turned_rad <= kMostTurn_rad) partners.push_back(other);
  }
  return partners;
}

std::vector<PixelDepth> sweep_depths(const StoredView& view, std::span<const StoredView* const> others,
                                     const GroundPlane* ground, std::span<const float> alpha,
                                     const SweepOptions& options) {
  const int least_side_px = std::min(view.camera().width_px, view.camera().height_px);
  if (others.empty() || least_side_px <= 2 * options.patch_px) return {};
  std::optional<FloorDepth> floor;
  if (ground != nullptr) floor.emplace(*ground, view.map_from_camera);
  const auto least_inverse_depth = [&](int x, int y) {
    const bool over_floor = floor && floor->height_m() > 0.0F;
    return over_floor ? floor->inverse_depth(ray_of(view.camera(), x, y)) : 0.0F;
  };
  std::vector<Partner> partners;
  for (const StoredView* other : others) partners.push_back(partner_of(view, *other));
  const GreyPicture own(view.picture);
  const int stride = options.stride_px;
  const int columns = (view.camera().width_px + stride - 1) / stride;
  const int rows = (view.camera().height_px + stride - 1) / stride;
  NumberGrid grid(columns, rows);
  thread::parallel_for(0, rows, [&](int row) {
    PatchCompare patch(view.camera(), options.patch_px);
    std::vector<float> differences(static_cast<std::size_t>(options.depths));
    for (int column = 0; column < columns; ++column) {
      const int x = column * stride;
      const int y = row * stride;
      if (!asked(view, alpha, x, y, options)) continue;
      patch.take(own, x, y);
      const float least = least_inverse_depth(x, y);
      for (int number = 0; number < options.depths; ++number) {
        differences[static_cast<std::size_t>(number)] =
            patch.mean_difference(partners, std::max(least, inverse_depth_of(number, options)));
      }
      grid.at(column, row) = choose(differences, options);
    }
  });
  std::vector<PixelDepth> depths;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (grid.at(column, row) == kNoDepth) continue;
      const int x = column * stride;
      const int y = row * stride;
      const float inverse_depth = inverse_depth_of(grid.median_around(column, row), options);
      depths.push_back({x, y, 1.0F / std::max(least_inverse_depth(x, y), inverse_depth)});
    }
  }
  return depths;
}

}  // namespace edgesplat::mapping
