// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/corner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace edgesplat::image {
namespace {

constexpr int kBlock = 4;
constexpr float kEdgeShare = 0.1F;
constexpr float kPixels = 4.0F * kBlock * kBlock;  // of a window

struct Tensor {
  float xx = 0.0F, xy = 0.0F, yy = 0.0F;
  Tensor& operator+=(const Tensor& other) {
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
    return *this;
  }
};

/// Gradients of the block of 4 x 4 pixels that begins at (x, y).
Tensor block_tensor(const sensor::ImageGray8& picture, int x, int y) {
  int xx = 0, xy = 0, yy = 0;
  for (int row = y; row < y + kBlock; ++row) {
    const std::uint8_t* at = picture.pixel(x, row);
    for (int i = 0; i < kBlock; ++i, ++at) {
      const int dx = at[1] - at[-1];
      const int dy = at[picture.width_px] - at[-picture.width_px];
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    }
  }
  return {0.25F * static_cast<float>(xx), 0.25F * static_cast<float>(xy), 0.25F * static_cast<float>(yy)};
}

float score_of(const Tensor& t) {
  const float mean = 0.5F * (t.xx + t.yy);
  const float half = 0.5F * (t.xx - t.yy);
  const float root = std::sqrt(half * half + t.xy * t.xy);
  return (mean - root + kEdgeShare * (mean + root)) / kPixels;
}

/// The first multiple of 4 at or above a positive number.
int up_to_block(int x) {
  return (x + kBlock - 1) / kBlock * kBlock;
}

}  // namespace

std::optional<Corner> strongest_corner(const sensor::ImageGray8& picture, const PixelBox& box) {
  const int x0 = up_to_block(std::max(box.x0, 1)), y0 = up_to_block(std::max(box.y0, 1));
  const int columns = (std::min(box.x1, picture.width_px - 1) - x0) / kBlock;
  const int rows = (std::min(box.y1, picture.height_px - 1) - y0) / kBlock;
  if (columns < 2 || rows < 2) return std::nullopt;
  std::vector<Tensor> above(static_cast<std::size_t>(columns)), here(above.size());
  Corner best;
  best.score = -1.0F;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      here[static_cast<std::size_t>(column)] = block_tensor(picture, x0 + column * kBlock, y0 + row * kBlock);
    for (std::size_t column = 1; row > 0 && column < here.size(); ++column) {
      Tensor window = above[column - 1];
      window += above[column];
      window += here[column - 1];
      window += here[column];
      const float score = score_of(window);
      if (score <= best.score) continue;
      best.score = score;
      best.centre_px = {static_cast<float>(x0 + static_cast<int>(column) * kBlock) - 0.5F,
                        static_cast<float>(y0 + row * kBlock) - 0.5F};
    }
    std::swap(above, here);
  }
  return best;
}

}  // namespace edgesplat::image
