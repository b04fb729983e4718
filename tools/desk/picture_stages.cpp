// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/picture_stages.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <utility>

namespace edgesplat::desk {
namespace {

/// `type` is OpenCV's; both spans hold pictures of it.
template <typename T>
void resize_area(const std::vector<T>& from, const geometry::CameraModel& from_camera, int type,
                 const geometry::CameraModel& to_camera, std::vector<T>& to) {
  const cv::Mat source(from_camera.height_px, from_camera.width_px, type, const_cast<T*>(from.data()));
  cv::Mat target(to_camera.height_px, to_camera.width_px, type, to.data());
  cv::resize(source, target, target.size(), 0, 0, cv::INTER_AREA);
}

}  // namespace

ScenePicture half_size(const ScenePicture& picture) {
  ScenePicture out;
  out.name = picture.name;
  out.map_from_camera = picture.map_from_camera;
  out.camera = picture.camera.scaled(0.5);
  out.picture = sensor::ImageRgb8(out.camera.width_px, out.camera.height_px);
  resize_area(picture.picture.values, picture.camera, CV_8UC3, out.camera, out.picture.values);
  const auto pixels =
      static_cast<std::size_t>(out.camera.width_px) * static_cast<std::size_t>(out.camera.height_px);
  if (!picture.weight.empty()) {
    out.weight.resize(pixels);
    resize_area(picture.weight, picture.camera, CV_32FC1, out.camera, out.weight);
    for (float& value : out.weight) value = value > 0.999F ? 1.0F : 0.0F;
  }
  if (!picture.depth_m.empty()) {
    out.depth_m.reserve(pixels);
    for (int y = 0; y < out.camera.height_px; ++y) {
      for (int x = 0; x < out.camera.width_px; ++x) {
        const int full_x = std::min(2 * x, picture.camera.width_px - 1);
        const int full_y = std::min(2 * y, picture.camera.height_px - 1);
        out.depth_m.push_back(picture.depth_m[static_cast<std::size_t>(full_y) *
                                                  static_cast<std::size_t>(picture.camera.width_px) +
                                              static_cast<std::size_t>(full_x)]);
      }
    }
  }
  return out;
}

const ScenePicture& PictureStages::at(std::size_t index, int shrink) {
  if (shrink <= 1) return *full_[index];
  if (half_[index].picture.values.empty()) half_[index] = half_size(*full_[index]);
  return half_[index];
}

}  // namespace edgesplat::desk
