// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/visual_growth.hpp"

#include "kernels/image/corner.hpp"
#include "robot/tracking/visual_normal.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace edgesplat::tracking {
namespace {

/// Mean squared gradients below this (grey levels a pixel) are the camera's noise.
constexpr float kMinScore = 2.5F;
constexpr std::uint8_t kMaxBad = 3;
constexpr int kMaxAdded = 120;
constexpr int kMaxRays = 80;
/// A value of a patch above this is likely to be cut off.
constexpr std::uint8_t kSaturated = 250;
/// The planes below a patch's corners are one, as far as the map knows: not farther off and not more slanted.
constexpr float kSamePlace_m = 0.03F;
constexpr float kSameDirection = 0.9F;
constexpr double kMostAcross_m = 3.0;

Eigen::Vector2f at_level(const Eigen::Vector2f& pixel, int level) {
  return ((pixel.array() + 0.5F) / std::ldexp(1.0F, level)) - 0.5F;
}

/// A look at a point on a plane at a pixel; nothing where its patches leave the picture or are overexposed.
std::optional<VisualObservation> observe(const PosedPicture& picture, const Eigen::Vector2f& pixel,
                                         const VisualPoint& point) {
  VisualObservation seen;
  seen.log_gain = picture.log_gain;
  for (int level = 0; level < kPatchLevels; ++level) {
    const auto patch = image::cut_patch(picture.pyramid.level(level), at_level(pixel, level));
    if (!patch) return std::nullopt;
    seen.patches[static_cast<std::size_t>(level)] = *patch;
  }
  if (std::ranges::count_if(seen.patches[0], [](std::uint8_t v) { return v > kSaturated; }) > 4)
    return std::nullopt;
  const CameraView& view = picture.view;
  const Eigen::Vector3d from_camera = point.p_in_odom_m - view.camera_in_odom_m;
  seen.from_camera_m = from_camera.cast<float>();
  const Eigen::Vector3d normal = point.normal.cast<double>();
  const Eigen::Matrix3d odom_from_camera = view.camera_from_odom.rotation.conjugate().toRotationMatrix();
  constexpr double kStep_px = 2.0;
  const auto step_on_plane = [&](double right_px, double down_px) -> Eigen::Vector3f {
    const auto meet = [&](double sign) -> Eigen::Vector3d {
      const Eigen::Vector2d at = pixel.cast<double>() + sign * kStep_px * Eigen::Vector2d(right_px, down_px);
      const Eigen::Vector3d ray = odom_from_camera * view.camera.unproject(at);
      return normal.dot(from_camera) / normal.dot(ray) * ray;
    };
    return ((meet(1.0) - meet(-1.0)) / (2.0 * kStep_px)).cast<float>();
  };
  seen.right_m = step_on_plane(1.0, 0.0);
  seen.down_m = step_on_plane(0.0, 1.0);
  const Eigen::Vector3f forward = odom_from_camera.col(2).cast<float>();
  const float depth_m = forward.dot(seen.from_camera_m);
  seen.growth = {forward.dot(seen.right_m) / depth_m, forward.dot(seen.down_m) / depth_m};
  if (!seen.right_m.allFinite() || !seen.down_m.allFinite()) return std::nullopt;
  return seen;
}

/// Looks for the plane behind a pixel: where the scan measured next to it, else along the ray.
class PlaneFinder {
 public:
  PlaneFinder(const PlaneMap& planes, const CameraView& view, const DepthCells& depths)
      : planes_(planes),
        view_(view),
        depths_(depths),
        odom_from_camera_(view.camera_from_odom.rotation.conjugate().toRotationMatrix()) {}

  [[nodiscard]] std::optional<PlaneHit> find(const Eigen::Vector2f& pixel) {
    const OdomRay ray{view_.camera_in_odom_m,
                      odom_from_camera_ * view_.camera.unproject(pixel.cast<double>())};
    const auto measured = depths_.nearest(pixel);
    std::optional<PlaneHit> hit;
    if (measured) {
      hit = meet_plane(planes_, ray, view_.camera_in_odom_m + odom_from_camera_ * measured->cast<double>());
    } else if (rays_ < kMaxRays) {
      ++rays_;
      hit = first_plane(planes_, ray);
    }
    if (!hit || !lies_on_plane(pixel, *hit)) return std::nullopt;
    const Eigen::Vector3d in_camera = view_.camera_from_odom * hit->p_in_odom_m;
    const PlaneInView plane{pixel, in_camera.cast<float>(),
                            odom_from_camera_.transpose().cast<float>() * hit->normal};
    return depths_.agree(plane) ? hit : std::nullopt;
  }

 private:
  /// The map has the same plane at the patch's corners: patches across an edge move as neither side does, and
  /// what stands out of a wall moves faster than it.
  [[nodiscard]] bool lies_on_plane(const Eigen::Vector2f& pixel, const PlaneHit& hit) const {
    constexpr double kReach_px = 0.5 * (image::kPatchSide - 1);
    const Eigen::Vector3d normal = hit.normal.cast<double>();
    const double offset_m = normal.dot(hit.p_in_odom_m - view_.camera_in_odom_m);
    for (const double dx : {-kReach_px, kReach_px}) {
      for (const double dy : {-kReach_px, kReach_px}) {
        const Eigen::Vector2d at = pixel.cast<double>() + Eigen::Vector2d(dx, dy);
        const Eigen::Vector3d direction = odom_from_camera_ * view_.camera.unproject(at);
        const Eigen::Vector3d corner_m =
            view_.camera_in_odom_m + offset_m / normal.dot(direction) * direction;
        if (!((corner_m - hit.p_in_odom_m).norm() < kMostAcross_m)) return false;
        const PlaneMatch match = planes_.find(corner_m);
        if (match.plane == nullptr || match.plane->normal.dot(hit.normal) < kSameDirection ||
            std::abs(match.plane->normal.dot(match.from_centre_m)) > kSamePlace_m)
          return false;
      }
    }
    return true;
  }

  const PlaneMap& planes_;
  const CameraView& view_;
  const DepthCells& depths_;
  Eigen::Matrix3d odom_from_camera_;
  int rays_ = 0;
};

}  // namespace

void judge_points(VisualMap& map, const PlaneMap* planes, std::span<const SelectedPatch> patches,
                  const VisualUpdateResult& update, const PosedPicture& picture) {
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const std::uint32_t index = patches[i].point;
    VisualPoint& point = map.point(index);
    if (!update.agreed(i)) {
      if (++point.bad >= kMaxBad) map.erase(index);
      continue;
    }
    point.bad = 0;
    point.good = static_cast<std::uint8_t>(std::min(point.good + 1, 255));
    if (planes != nullptr) refine_normal(map, point, *planes);
    const auto seen = look_at(picture.view, point.p_in_odom_m);
    if (!seen || !is_new_view(map, point, *seen, picture.view.camera_in_odom_m)) continue;
    if (const auto look = observe(picture, seen->pixel.cast<float>(), point)) map.observe(index, *look);
  }
}

int add_points(VisualMap& map, const PlaneMap& planes, const PosedPicture& picture, const PictureGrid& grid,
               const DepthCells& depths, const std::vector<bool>& occupied, std::uint32_t round) {
  PlaneFinder finder(planes, picture.view, depths);
  int added = 0;
  const int cells = grid.cells();
  // Steps of a number without common factor with any grid reach each cell once, in an order that spreads.
  constexpr int kStride = 7919;
  for (int i = 0; i < cells && added < kMaxAdded; ++i) {
    const auto cell = static_cast<int>((static_cast<std::int64_t>(i) * kStride + round) % cells);
    if (occupied[static_cast<std::size_t>(cell)]) continue;
    const Eigen::Vector2i from = grid.corner_px(cell);
    const auto corner = image::strongest_corner(
        picture.pyramid.level(0), {from.x(), from.y(), from.x() + grid.cell_px(), from.y() + grid.cell_px()});
    if (!corner || corner->score < kMinScore) continue;
    const auto hit = finder.find(corner->centre_px);
    if (!hit) continue;
    VisualPoint point;
    point.p_in_odom_m = hit->p_in_odom_m;
    point.normal = hit->normal;
    point.doubt_m =
        hit->along_sigma_m * (hit->p_in_odom_m - picture.view.camera_in_odom_m).normalized().cast<float>();
    const auto look = observe(picture, corner->centre_px, point);
    if (!look) continue;
    map.observe(map.add(point), *look);
    ++added;
  }
  return added;
}

}  // namespace edgesplat::tracking
