// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/camera_model.hpp"
#include "common/sensor/image.hpp"

#include <vector>

namespace edgesplat::image {

/// Brightness (ITU-R BT.601 weights on the sRGB values) at halving sizes, each pixel the mean of 2 x 2 of the
/// level before. Level 0 may itself be the picture at 1/2, 1/4, ... of its size. Keeps its memory between
/// pictures. Single-owner.
class GrayPyramid {
 public:
  /// `skip`: how often the picture is halved to become level 0, 0..4; `levels` >= 1, each at least 2 x 2.
  void build(const sensor::ImageRgb8& picture, int skip, int levels);

  [[nodiscard]] const sensor::ImageGray8& level(int l) const { return levels_[static_cast<std::size_t>(l)]; }
  [[nodiscard]] int levels() const { return static_cast<int>(levels_.size()); }

 private:
  std::vector<sensor::ImageGray8> levels_;
};

/// The camera of a picture halved `times` times (an odd last row or column is cut off).
[[nodiscard]] geometry::CameraModel halved(const geometry::CameraModel& camera, int times);

}  // namespace edgesplat::image
