// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/image.hpp"

#include <Eigen/Core>

#include <optional>

namespace edgesplat::image {

/// Part of a picture: [x0, x1) x [y0, y1).
struct PixelBox {
  int x0, y0, x1, y1;
};

struct Corner {
  Eigen::Vector2f centre_px;
  float score = 0.0F;  ///< smaller eigenvalue of the mean gradient tensor plus a tenth of the larger one
};

/// The 8 x 8 window with the highest score inside a box, after Shi and Tomasi; edges count a little. Centres
/// lie where x + 1/2 and y + 1/2 are multiples of 4: there a patch of pyramid levels 0 to 2 falls on whole
/// pixels. Nothing where the box holds no window with one pixel around it.
[[nodiscard]] std::optional<Corner> strongest_corner(const sensor::ImageGray8& picture, const PixelBox& box);

}  // namespace edgesplat::image
