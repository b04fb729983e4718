// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/stored_view.hpp"

#include "kernels/mapping/pixel_projector.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace edgesplat::mapping {
namespace {

constexpr float kNearest_m = 0.1F;
constexpr int kSkyMargin_px = 8;

}  // namespace

std::vector<SparseDepth> project_depths(std::span<const map::ColouredPoint> points_in_body,
                                        const geometry::RigidTransform& camera_from_body,
                                        const geometry::CameraModel& pinhole) {
  const PixelProjector projector(camera_from_body, pinhole);
  std::vector<float> nearest(
      static_cast<std::size_t>(pinhole.width_px) * static_cast<std::size_t>(pinhole.height_px), 0.0F);
  for (const map::ColouredPoint& point : points_in_body) {
    const auto hit = projector.project(point.p_in_body_m, kNearest_m);
    if (!hit) continue;
    float& depth = nearest[static_cast<std::size_t>(hit->y) * static_cast<std::size_t>(pinhole.width_px) +
                           static_cast<std::size_t>(hit->x)];
    if (depth == 0.0F || hit->depth_m < depth) depth = hit->depth_m;
  }
  std::vector<SparseDepth> depths;
  for (std::size_t pixel = 0; pixel < nearest.size(); ++pixel) {
    if (nearest[pixel] > 0.0F) depths.push_back({static_cast<std::uint32_t>(pixel), nearest[pixel]});
  }
  return depths;
}

std::vector<bool> above_measured(int margin_px, const StoredView& view) {
  constexpr std::uint32_t kStretch_px = 8;
  const auto width = static_cast<std::uint32_t>(view.camera().width_px);
  const auto height = static_cast<std::uint32_t>(view.camera().height_px);
  const std::uint32_t stretches = (width + kStretch_px - 1) / kStretch_px;
  std::vector<std::uint32_t> highest(stretches, height);  // row; height: none
  for (const SparseDepth& d : view.depths) {
    std::uint32_t& row = highest[d.pixel % width / kStretch_px];
    row = std::min(row, d.pixel / width);
  }
  std::vector<bool> above;
  for (std::uint32_t x = 0; x < width; ++x) {
    const std::uint32_t stretch = x / kStretch_px;
    const auto first = highest.begin() + (stretch > 2 ? stretch - 2 : 0);
    const std::uint32_t top = *std::min_element(first, highest.begin() + std::min(stretches, stretch + 3));
    if (top == height || top <= static_cast<std::uint32_t>(margin_px)) continue;
    if (above.empty()) above.resize(std::size_t{width} * height, false);
    for (std::uint32_t y = 0; y + static_cast<std::uint32_t>(margin_px) < top; ++y) {
      above[std::size_t{y} * width + x] = true;
    }
  }
  return above;
}

Result<StoredView> make_view(const map::Keyframe& keyframe, const geometry::RigidTransform& map_from_body,
                             const sensor::ImageRgb8& picture,
                             std::shared_ptr<const image::Undistorter> undistorter) {
  const geometry::CameraModel& model = undistorter->model();
  if (!undistorter->fits(picture)) {
    return fail(Errc::kInvalidArgument,
                "keyframe " + std::to_string(keyframe.id.value) + "'s picture is not of its camera's size");
  }
  StoredView view;
  view.keyframe = keyframe.id;
  view.pose_version = keyframe.pose_version;
  view.map_from_camera = map_from_body * keyframe.camera->body_from_camera;
  view.exposure_known = keyframe.exposure_s > 0.0F;
  view.picture = undistorter->apply(picture);
  view.depths = project_depths(keyframe.points_in_body, keyframe.camera->body_from_camera.inverse(), model);
  view.undistorter = std::move(undistorter);
  view.unmapped = above_measured(kSkyMargin_px, view);
  return view;
}

}  // namespace edgesplat::mapping
