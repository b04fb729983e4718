// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/tile_lists.hpp"

#include <algorithm>
#include <cstddef>

namespace edgesplat::splat {

/// A tile as blocks of 4x4 pixels, each a vector of 16: a splat of a few pixels touches fewer blocks than
/// rows.
inline constexpr int kBlockPx = 4;
inline constexpr int kBlockColumns = kTileWidthPx / kBlockPx;
inline constexpr int kBlockRows = kTileHeightPx / kBlockPx;
inline constexpr int kBlocks = kBlockColumns * kBlockRows;
inline constexpr int kBlockPixels = kBlockPx * kBlockPx;
static_assert(kBlocks <= 32, "a block is a bit of TileEntry::reached");

/// One quantity of every pixel of a tile.
struct alignas(64) TilePlane {
  float at[kBlocks][kBlockPixels];
};

/// Place of a pixel of a tile.
constexpr int block_of(int x, int y) {
  return y / kBlockPx * kBlockColumns + x / kBlockPx;
}
constexpr int pixel_of(int x, int y) {
  return y % kBlockPx * kBlockPx + x % kBlockPx;
}

/// From a tile's first pixel to its centre.
inline constexpr float kTileHalfX_px = 0.5F * static_cast<float>(kTileWidthPx - 1);
inline constexpr float kTileHalfY_px = 0.5F * static_cast<float>(kTileHeightPx - 1);

/// Where each pixel lies from its tile's centre.
struct TilePlaces {
  TilePlane x, y, xx, xy, yy;
};
constexpr TilePlaces tile_places() {
  TilePlaces places{};
  for (int y = 0; y < kTileHeightPx; ++y) {
    for (int x = 0; x < kTileWidthPx; ++x) {
      const int b = block_of(x, y), i = pixel_of(x, y);
      const float from_x = static_cast<float>(x) - kTileHalfX_px,
                  from_y = static_cast<float>(y) - kTileHalfY_px;
      places.x.at[b][i] = from_x;
      places.y.at[b][i] = from_y;
      places.xx.at[b][i] = from_x * from_x;
      places.xy.at[b][i] = from_x * from_y;
      places.yy.at[b][i] = from_y * from_y;
    }
  }
  return places;
}
inline constexpr TilePlaces kTilePlaces = tile_places();

/// Where a tile lies in the picture.
struct TilePixels {
  int x0_px, y0_px;         ///< first pixel
  int width_px, height_px;  ///< of what lies in the picture
  int stride_px;            ///< the picture's width

  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y0_px + y) * static_cast<std::size_t>(stride_px) +
           static_cast<std::size_t>(x0_px + x);
  }
  [[nodiscard]] float centre_x_px() const { return static_cast<float>(x0_px) + kTileHalfX_px; }
  [[nodiscard]] float centre_y_px() const { return static_cast<float>(y0_px) + kTileHalfY_px; }
};
/// The t-th of the lists' tiles.
inline TilePixels tile_pixels(const TileLists& lists, int t, const View& view) {
  const int x0 = t % lists.columns * kTileWidthPx, y0 = t / lists.columns * kTileHeightPx;
  return {x0, y0, std::min(kTileWidthPx, view.width_px - x0), std::min(kTileHeightPx, view.height_px - y0),
          view.width_px};
}

}  // namespace edgesplat::splat
