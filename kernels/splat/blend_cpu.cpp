// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/parallel_for.hpp"
#include "kernels/core/simd_variants.hpp"
#include "kernels/splat/blend.hpp"
#include "kernels/splat/pixel_alpha.hpp"
#include "kernels/splat/tile_blocks.hpp"

#include <algorithm>
#include <bit>

namespace edgesplat::splat {
namespace {

/// A tile's accumulators, channel by channel so that a block of pixels is a vector.
struct Tile {
  TilePlane transmittance;  ///< negative, its size kept, once the pixel is full
  TilePlane red, green, blue, depth;
};

void clear(Tile& tile) {
  tile = {};
  std::fill_n(&tile.transmittance[0][0], kBlocks * kBlockPixels, 1.0F);
}

/// Adds one splat to block k, whose first pixel lies at (left, top) from its centre.
EDGESPLAT_INLINE void add_to_block(const Splat& s, const Falloff f, float left, float top, int k,
                                   Tile& tile) {
  for (int i = 0; i < kBlockPixels; ++i) {
    const float alpha = blended_alpha(raw_alpha(f, left + kPixelX[i], top + kPixelY[i]));
    const float before = tile.transmittance[k][i];
    const float after = before * (1.0F - alpha);
    const bool takes = after >= kMinTransmittance;
    const float weight = takes ? alpha * before : 0.0F;
    tile.red[k][i] = std::fma(weight, s.rgb[0], tile.red[k][i]);
    tile.green[k][i] = std::fma(weight, s.rgb[1], tile.green[k][i]);
    tile.blue[k][i] = std::fma(weight, s.rgb[2], tile.blue[k][i]);
    tile.depth[k][i] = std::fma(weight, s.depth_m, tile.depth[k][i]);
    tile.transmittance[k][i] = takes ? after : -std::abs(before);
  }
}

void write_tile(const Tile& tile, int column, int row, const View& view, const RenderOptions& options,
                const BlendOutputs& out) {
  const int x0 = column * kTilePx;
  const int y0 = row * kTilePx;
  for (int y = 0; y < std::min(kTilePx, view.height_px - y0); ++y) {
    for (int x = 0; x < std::min(kTilePx, view.width_px - x0); ++x) {
      const auto pixel = static_cast<std::size_t>(y0 + y) * static_cast<std::size_t>(view.width_px) +
                         static_cast<std::size_t>(x0 + x);
      const int k = block_of(x, y);
      const int i = pixel_of(x, y);
      const float left = std::abs(tile.transmittance[k][i]);
      out.colour[3 * pixel] = tile.red[k][i] + left * options.background[0];
      out.colour[3 * pixel + 1] = tile.green[k][i] + left * options.background[1];
      out.colour[3 * pixel + 2] = tile.blue[k][i] + left * options.background[2];
      out.depth_sum_m[pixel] = tile.depth[k][i];
      out.alpha[pixel] = 1.0F - left;
    }
  }
}

EDGESPLAT_INLINE void blend_tile_inline(std::span<const Splat> splats, std::span<const std::uint32_t> list,
                                        int column, int row, Tile& tile) {
  constexpr std::size_t kCheckEvery = 16;  // looking which blocks are full costs about one splat
  const auto x0 = static_cast<float>(column * kTilePx);
  const auto y0 = static_cast<float>(row * kTilePx);
  clear(tile);
  std::uint32_t active = (1U << kBlocks) - 1;
  for (std::size_t i = 0; i < list.size() && active != 0; ++i) {
    if (i + kPrefetchAhead < list.size()) __builtin_prefetch(&splats[list[i + kPrefetchAhead]]);
    const Splat s = splats[list[i]];  // a copy: else the compiler fears that the tile overlaps it
    const Falloff falloff = falloff_of(s);
    for (std::uint32_t todo = blocks_reached(s, x0, y0) & active; todo != 0; todo &= todo - 1) {
      const int k = std::countr_zero(todo);
      add_to_block(s, falloff, x0 - s.u_px + 4.0F * kPixelX[k], y0 - s.v_px + 4.0F * kPixelY[k], k, tile);
    }
    if (i % kCheckEvery == kCheckEvery - 1) active = blocks_active(tile.transmittance);
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
  thread::parallel_for(0, tiles.columns * tiles.rows, [&](int t) {
    const int column = t % tiles.columns;
    const int row = t / tiles.columns;
    Tile tile;
    draw(splats, tiles.tile(column, row), column, row, tile);
    write_tile(tile, column, row, view, options, out);
  });
}

}  // namespace edgesplat::splat
