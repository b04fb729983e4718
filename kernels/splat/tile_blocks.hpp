// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/tile_lists.hpp"

namespace edgesplat::splat {

/// A tile as 16 blocks of 4x4 pixels, each a vector of 16: a splat of a few pixels touches fewer blocks than
/// rows.
inline constexpr int kBlockPx = 4;
inline constexpr int kBlocks = 16;
inline constexpr int kBlockPixels = 16;
static_assert(kTilePx == 4 * kBlockPx);

/// One quantity of every pixel of a tile.
struct alignas(64) TilePlane {
  float at[kBlocks][kBlockPixels];
};

/// Place of a pixel of a tile, x and y in 0..15.
constexpr int block_of(int x, int y) {
  return y / kBlockPx * kBlockPx + x / kBlockPx;
}
constexpr int pixel_of(int x, int y) {
  return y % kBlockPx * kBlockPx + x % kBlockPx;
}

/// From a tile's first pixel to its centre.
inline constexpr float kTileHalfPx = 0.5F * static_cast<float>(kTilePx - 1);

/// Where each pixel lies from its tile's centre.
struct TilePlaces {
  alignas(64) float x[kBlocks][kBlockPixels];
  alignas(64) float y[kBlocks][kBlockPixels];
  alignas(64) float xx[kBlocks][kBlockPixels];
  alignas(64) float xy[kBlocks][kBlockPixels];
  alignas(64) float yy[kBlocks][kBlockPixels];
};
constexpr TilePlaces tile_places() {
  TilePlaces places{};
  for (int y = 0; y < kTilePx; ++y) {
    for (int x = 0; x < kTilePx; ++x) {
      const int b = block_of(x, y), i = pixel_of(x, y);
      const float from_x = static_cast<float>(x) - kTileHalfPx, from_y = static_cast<float>(y) - kTileHalfPx;
      places.x[b][i] = from_x;
      places.y[b][i] = from_y;
      places.xx[b][i] = from_x * from_x;
      places.xy[b][i] = from_x * from_y;
      places.yy[b][i] = from_y * from_y;
    }
  }
  return places;
}
inline constexpr TilePlaces kTilePlaces = tile_places();

}  // namespace edgesplat::splat
