// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/visual_selection.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::tracking {
namespace {

constexpr double kNearest_m = 0.3;
constexpr double kFarthest_m = 60.0;
/// Room for a patch at the picture's edge, in pixels of the finest level.
constexpr double kBorder_px = 6.0;
constexpr int kProven = 5;
/// A plane must face the camera at least this much.
constexpr double kMinFacing = 0.1;

struct Candidate {
  std::uint32_t point = ~std::uint32_t{0};
  int good = -1;
  double distance_m = 0.0;
};

}  // namespace

PictureGrid::PictureGrid(int width_px, int height_px)
    : cell_px_(std::max(16, width_px / 20)),
      columns_((width_px + cell_px_ - 1) / cell_px_),
      rows_((height_px + cell_px_ - 1) / cell_px_) {}

int PictureGrid::cell_of(const Eigen::Vector2d& pixel) const {
  const int x = std::clamp(static_cast<int>(pixel.x()) / cell_px_, 0, columns_ - 1);
  const int y = std::clamp(static_cast<int>(pixel.y()) / cell_px_, 0, rows_ - 1);
  return y * columns_ + x;
}

std::vector<SelectedPatch> select_patches(const VisualMap& map, const CameraView& view,
                                          const PictureGrid& grid, const DepthCells& depths) {
  std::vector<Candidate> best(static_cast<std::size_t>(grid.cells()));
  const Eigen::Matrix3d rotation = view.camera_from_odom.rotation.toRotationMatrix();
  const Eigen::Vector3d forward = rotation.row(2);
  for (std::uint32_t index = 0; index < map.slots(); ++index) {
    const VisualPoint& point = map.point(index);
    if (!point.live) continue;
    const Eigen::Vector3d ray = point.p_in_odom_m - view.camera_in_odom_m;
    const double distance_m = ray.norm();
    if (distance_m > kFarthest_m || forward.dot(ray) < kNearest_m) continue;
    if (-point.normal.cast<double>().dot(ray) < kMinFacing * distance_m) continue;
    const auto pixel = view.camera.project(rotation * ray);
    if (!pixel || !view.camera.contains(*pixel, kBorder_px)) continue;
    Candidate& rival = best[static_cast<std::size_t>(grid.cell_of(*pixel))];
    const int good = std::min<int>(point.good, kProven);
    if (good < rival.good || (good == rival.good && distance_m >= rival.distance_m)) continue;
    rival = {index, good, distance_m};
  }
  std::vector<SelectedPatch> selected;
  for (const Candidate& candidate : best) {
    if (candidate.good < 0) continue;
    const VisualPoint& point = map.point(candidate.point);
    const auto seen = look_at(view, point.p_in_odom_m);
    if (!seen) continue;
    const auto reference = choose_reference(map, point, *seen, view.camera_in_odom_m);
    if (!reference) continue;
    const PlaneInView plane{seen->pixel.cast<float>(), seen->p_in_camera_m.cast<float>(),
                            rotation.cast<float>() * point.normal};
    if (depths.agree(plane)) selected.push_back({candidate.point, *reference});
  }
  return selected;
}

}  // namespace edgesplat::tracking
