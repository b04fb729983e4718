// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"
#include "kernels/splat/project.hpp"

#include <cmath>

namespace edgesplat::splat {

/// Which tiles a splat reaches, row of tiles by row of tiles, in time of the rows instead of the tiles:
/// within one row the part of the ellipse {alpha >= 1/255} is convex, so it covers an interval of x and
/// exactly the tiles that meet it. Host and device. Tile (c, r) stands for the pixel centres [16 c, 16 c +
/// 15] x [16 r, 16 r + 15].

inline constexpr int kReachTilePx = 16;

struct TileInterval {
  int first, last;  ///< [first, last)
};

/// Tiles of which some pixel centre lies in [low, high], out of `tiles`. A bound that is not a number does
/// not bound.
EDGESPLAT_HOST_DEVICE inline TileInterval tiles_between(float low, float high, int tiles) {
  constexpr auto kTile = static_cast<float>(kReachTilePx);
  // Tile t begins before `high` and ends after `low`: 16 t <= high, 16 t + 15 >= low.
  const float begin = std::ceil((low - (kTile - 1.0F)) / kTile);
  const float end = std::floor(high / kTile) + 1.0F;
  const auto most = static_cast<float>(tiles);
  if (begin >= most || end <= 0.0F || begin >= end) return {0, 0};
  return {begin > 0.0F ? static_cast<int>(begin) : 0, end < most ? static_cast<int>(end) : tiles};
}

/// More than the blend's own threshold by this, so that rounding never loses a pixel.
inline constexpr float kReachSlack = 1.0001F;
inline constexpr float kReachSlack_px = 0.02F;

EDGESPLAT_HOST_DEVICE inline TileInterval rows_reached(const Splat& s, int rows) {
  const float half = s.half_height_px * kReachSlack + kReachSlack_px;
  return tiles_between(s.v_px - half, s.v_px + half, rows);
}

/// Columns that the splat reaches in one row of tiles. At height dy from its centre the ellipse is
/// -b/a dy ± sqrt(reach2 (1 - dy^2 / half_height^2) / a) wide; its rightmost point lies at dy = -b/c
/// half_width and its leftmost one opposite. No differences of large numbers, so needles come out right.
EDGESPLAT_HOST_DEVICE inline TileInterval columns_reached(const Splat& s, int row, int columns) {
  const float a = s.conic[0], b = s.conic[1], c = s.conic[2];
  const float half_height = s.half_height_px * kReachSlack + kReachSlack_px;
  const float half_width = s.half_width_px * kReachSlack + kReachSlack_px;
  const float top = static_cast<float>(row * kReachTilePx) - s.v_px;
  const float bottom = top + static_cast<float>(kReachTilePx - 1);
  const float low = top > -half_height ? top : -half_height;
  const float high = bottom < half_height ? bottom : half_height;
  if (!(low <= high)) return {0, 0};
  const float reach2 = s.reach2 * kReachSlack + 1e-4F;
  const auto edge = [&](float dy_extreme, float side) {
    if (dy_extreme >= low && dy_extreme <= high) return side * half_width;
    const float dy = dy_extreme < low ? low : high;
    const float share = dy / half_height;
    const float open = 1.0F - share * share;
    return -b / a * dy + side * (std::sqrt((open > 0.0F ? open : 0.0F) * reach2 / a) + kReachSlack_px);
  };
  const float tilt = -b / c * half_width;
  return tiles_between(s.u_px + edge(-tilt, -1.0F), s.u_px + edge(tilt, 1.0F), columns);
}

/// Tiles that the splat reaches.
EDGESPLAT_HOST_DEVICE inline unsigned long long tiles_reached(const Splat& s, int columns, int rows) {
  const TileInterval in_rows = rows_reached(s, rows);
  unsigned long long count = 0;
  for (int row = in_rows.first; row < in_rows.last; ++row) {
    const TileInterval in_columns = columns_reached(s, row, columns);
    count += static_cast<unsigned long long>(in_columns.last - in_columns.first);
  }
  return count;
}

}  // namespace edgesplat::splat
