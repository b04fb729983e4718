// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/simd_variants.hpp"
#include "kernels/splat/blend.hpp"
#include "kernels/splat/pixel_alpha.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace edgesplat::splat {
namespace {

/// A tile's accumulators, channel by channel so that a row of 16 pixels is a vector.
struct Tile {
  float transmittance[kTilePx][kTilePx];
  float active[kTilePx][kTilePx];  ///< 1 until the pixel is full, then 0
  float red[kTilePx][kTilePx];
  float green[kTilePx][kTilePx];
  float blue[kTilePx][kTilePx];
  float depth[kTilePx][kTilePx];
};

void clear(Tile& tile) {
  for (int y = 0; y < kTilePx; ++y) {
    for (int x = 0; x < kTilePx; ++x) {
      tile.transmittance[y][x] = 1.0F;
      tile.active[y][x] = 1.0F;
      tile.red[y][x] = tile.green[y][x] = tile.blue[y][x] = tile.depth[y][x] = 0.0F;
    }
  }
}

/// Adds one splat to one row of pixels. By value: else the compiler fears that the tile overlaps the splat.
EDGESPLAT_INLINE void add_to_row(const Splat s, float x0_px, float dy, int y, Tile& tile) {
  const RowOfSplat row = row_of(s, dy);
  for (int x = 0; x < kTilePx; ++x) {
    const float alpha = blended_alpha(raw_alpha(s.opacity, row, x0_px + static_cast<float>(x) - s.u_px));
    const float before = tile.transmittance[y][x];
    const float after = before * (1.0F - alpha);
    const float active = after >= kMinTransmittance ? tile.active[y][x] : 0.0F;
    const float weight = active * alpha * before;
    tile.red[y][x] += weight * s.rgb[0];
    tile.green[y][x] += weight * s.rgb[1];
    tile.blue[y][x] += weight * s.rgb[2];
    tile.depth[y][x] += weight * s.depth_m;
    tile.transmittance[y][x] = active > 0.0F ? after : before;
    tile.active[y][x] = active;
  }
}

EDGESPLAT_INLINE bool any_active(const Tile& tile) {
  float sum = 0.0F;
  for (const auto& row : tile.active) {
    for (const float active : row) sum += active;
  }
  return sum > 0.0F;
}

void write_tile(const Tile& tile, int column, int row, const View& view, const RenderOptions& options,
                const BlendOutputs& out) {
  const int x0 = column * kTilePx;
  const int y0 = row * kTilePx;
  for (int y = 0; y < std::min(kTilePx, view.height_px - y0); ++y) {
    for (int x = 0; x < std::min(kTilePx, view.width_px - x0); ++x) {
      const auto pixel = static_cast<std::size_t>(y0 + y) * static_cast<std::size_t>(view.width_px) +
                         static_cast<std::size_t>(x0 + x);
      const float left = tile.transmittance[y][x];
      out.colour[3 * pixel] = tile.red[y][x] + left * options.background[0];
      out.colour[3 * pixel + 1] = tile.green[y][x] + left * options.background[1];
      out.colour[3 * pixel + 2] = tile.blue[y][x] + left * options.background[2];
      out.depth_sum_m[pixel] = tile.depth[y][x];
      out.alpha[pixel] = 1.0F - left;
    }
  }
}

EDGESPLAT_INLINE void blend_tile_inline(std::span<const Splat> splats, std::span<const std::uint32_t> list,
                                        int column, int row, Tile& tile) {
  constexpr std::size_t kCheckEvery = 16;  // looking whether the tile is full costs about one splat
  const auto x0 = static_cast<float>(column * kTilePx);
  const auto y0 = static_cast<float>(row * kTilePx);
  clear(tile);
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (i + kPrefetchAhead < list.size()) prefetch(splats[list[i + kPrefetchAhead]]);
    const Splat& s = splats[list[i]];
    const TileRows rows = rows_reached(s, y0);
    for (int y = rows.first; y <= rows.last; ++y)
      add_to_row(s, x0, y0 + static_cast<float>(y) - s.v_px, y, tile);
    if (i % kCheckEvery == kCheckEvery - 1 && !any_active(tile)) return;
  }
}

EDGESPLAT_SIMD_VARIANTS(blend_tile,
                        (std::span<const Splat> splats, std::span<const std::uint32_t> list, int column,
                         int row, Tile& tile),
                        (splats, list, column, row, tile))

}  // namespace

void blend(std::span<const Splat> splats, const TileLists& tiles, const View& view,
           const RenderOptions& options, const BlendOutputs& out) {
  const auto draw = fastest_blend_tile();
  tbb::parallel_for(0, tiles.columns * tiles.rows, [&](int t) {
    const int column = t % tiles.columns;
    const int row = t / tiles.columns;
    Tile tile;
    draw(splats, tiles.tile(column, row), column, row, tile);
    write_tile(tile, column, row, view, options, out);
  });
}

}  // namespace edgesplat::splat
