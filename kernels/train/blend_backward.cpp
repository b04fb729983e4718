// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/blend_backward.hpp"

#include "common/base/check.hpp"
#include "common/thread/parallel_for.hpp"
#include "kernels/core/simd_variants.hpp"
#include "kernels/splat/pixel_alpha.hpp"
#include "kernels/splat/tile_blocks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace edgesplat::train {
namespace {

using splat::kTilePx;
using splat::Splat;

using splat::kBlockPixels;
using splat::TilePlane;

/// A tile's pixels, channel by channel so that a block of 16 is a vector.
struct Tile {
  TilePlane transmittance;  ///< 0 once the pixel is full
  TilePlane
      rest;  ///< dL by picture times what the splats still to come and the background add; 0 once it is full
  TilePlane by_red, by_green, by_blue, by_depth;
};

/// Sums over the pixels of one tile for one splat: moments about its centre of g, dL by the exponent of its
/// falloff, and dL by what it adds.
enum Sum { kG, kGx, kGy, kGxx, kGxy, kGyy, kRed, kGreen, kBlue, kDepth, kWeight, kUsed, kSums = 16 };
/// Place by place in the block, to be added up at the end.
using LaneSums = float[kSums][kBlockPixels];

/// One splat on block k, whose first pixel lies at (left, top) from its centre. With T the transmittance
/// before it, q = dL by picture times what it would add at weight 1, R the rest behind it: dL/dalpha = T q -
/// R / (1 - alpha).
EDGESPLAT_INLINE void add_block(const Splat& s, const splat::Falloff f, float left, float top, int k,
                                Tile& tile, LaneSums& sums) {
  for (int i = 0; i < kBlockPixels; ++i) {
    const float dx = left + splat::kPixelX[i];
    const float dy = top + splat::kPixelY[i];
    const float raw = splat::raw_alpha(f, dx, dy);
    const float alpha = splat::blended_alpha(raw);
    const float before = tile.transmittance[k][i];
    const float after = before * (1.0F - alpha);
    const bool takes = after >= splat::kMinTransmittance;
    const float weight = takes ? alpha * before : 0.0F;
    const float by_red = tile.by_red[k][i], by_green = tile.by_green[k][i];
    const float by_blue = tile.by_blue[k][i], by_depth = tile.by_depth[k][i];
    const float q = std::fma(by_red, s.rgb[0],
                             std::fma(by_green, s.rgb[1], std::fma(by_blue, s.rgb[2], by_depth * s.depth_m)));
    const float rest = takes ? std::fma(-weight, q, tile.rest[k][i]) : 0.0F;
    const float by_alpha = std::fma(before, q, -rest / (1.0F - alpha));
    // alpha is 0 where it is skipped and constant where it is cut.
    const float g = (takes && raw < splat::kMaxAlpha ? alpha : 0.0F) * by_alpha;
    const float gx = g * dx;
    const float gy = g * dy;
    sums[kG][i] += g;
    sums[kGx][i] += gx;
    sums[kGy][i] += gy;
    sums[kGxx][i] = std::fma(gx, dx, sums[kGxx][i]);
    sums[kGxy][i] = std::fma(gx, dy, sums[kGxy][i]);
    sums[kGyy][i] = std::fma(gy, dy, sums[kGyy][i]);
    sums[kRed][i] = std::fma(weight, by_red, sums[kRed][i]);
    sums[kGreen][i] = std::fma(weight, by_green, sums[kGreen][i]);
    sums[kBlue][i] = std::fma(weight, by_blue, sums[kBlue][i]);
    sums[kDepth][i] = std::fma(weight, by_depth, sums[kDepth][i]);
    sums[kWeight][i] += weight;
    tile.rest[k][i] = rest;
    tile.transmittance[k][i] = takes ? after : 0.0F;
  }
}

/// Sums of all quantities at once, always in the same order: halves onto halves. The loops stay loops: only
/// then does g++ make shuffles of whole vectors of them.
EDGESPLAT_INLINE void add_up(const LaneSums& lanes, TileSums& out) {
  float half[8 * kSums];
  float quarter[4 * kSums];
#pragma GCC unroll 1
  for (int k = 0; k < kSums; ++k) {
    for (int i = 0; i < 8; ++i) half[8 * k + i] = lanes[k][i] + lanes[k][i + 8];
  }
#pragma GCC unroll 1
  for (int k = 0; k < kSums; ++k) {
    for (int i = 0; i < 4; ++i) quarter[4 * k + i] = half[8 * k + i] + half[8 * k + i + 4];
  }
#pragma GCC unroll 1
  for (int k = 0; k < kSums; ++k) {
    const float* q = quarter + 4 * k;
    out.sums[k] = (q[0] + q[2]) + (q[1] + q[3]);
  }
}

struct TileTask {
  std::span<const Splat> splats;
  std::span<const std::uint32_t> list;
  std::span<const std::uint32_t> slots;
  std::span<TileSums> by_slot;
  float x0_px, y0_px;
};

EDGESPLAT_INLINE void reverse_tile_inline(const TileTask& task, Tile& tile) {
  constexpr std::size_t kCheckEvery = 16;
  std::uint32_t active = (1U << splat::kBlocks) - 1;
  LaneSums sums = {};
  std::size_t i = 0;
  for (; i < task.list.size() && active != 0; ++i) {
    if (i + splat::kPrefetchAhead < task.list.size()) {
      __builtin_prefetch(&task.splats[task.list[i + splat::kPrefetchAhead]]);
      __builtin_prefetch(&task.by_slot[task.slots[i + splat::kPrefetchAhead]], 1);
    }
    const Splat s = task.splats[task.list[i]];  // a copy, see blend_cpu.cpp
    const splat::Falloff falloff = splat::falloff_of(s);
    for (int k = 0; k < kUsed; ++k) std::fill_n(sums[k], kBlockPixels, 0.0F);
    for (std::uint32_t todo = splat::blocks_reached(s, task.x0_px, task.y0_px) & active; todo != 0;
         todo &= todo - 1) {
      const int k = std::countr_zero(todo);
      add_block(s, falloff, task.x0_px - s.u_px + 4.0F * splat::kPixelX[k],
                task.y0_px - s.v_px + 4.0F * splat::kPixelY[k], k, tile, sums);
    }
    add_up(sums, task.by_slot[task.slots[i]]);
    if (i % kCheckEvery == kCheckEvery - 1) active = splat::blocks_active(tile.transmittance);
  }
  for (; i < task.list.size(); ++i) task.by_slot[task.slots[i]] = {};
}

EDGESPLAT_SIMD_VARIANTS(reverse_tile, (const TileTask& task, Tile& tile), (task, tile))

/// The tile's pixels before the first splat. Those beyond the picture's edge take no gradient.
void load_tile(int column, int row, const splat::View& view, const Pictures& drawn,
               const PictureGradients& by_picture, Tile& tile) {
  tile = {};
  const int x0 = column * kTilePx;
  const int y0 = row * kTilePx;
  for (int y = 0; y < std::min(kTilePx, view.height_px - y0); ++y) {
    for (int x = 0; x < std::min(kTilePx, view.width_px - x0); ++x) {
      const auto pixel = static_cast<std::size_t>(y0 + y) * static_cast<std::size_t>(view.width_px) +
                         static_cast<std::size_t>(x0 + x);
      const float* by_colour = &by_picture.colour[3 * pixel];
      const float* colour = &drawn.colour[3 * pixel];
      const float by_depth = by_picture.depth_sum.empty() ? 0.0F : by_picture.depth_sum[pixel];
      const float by_alpha = by_picture.alpha.empty() ? 0.0F : by_picture.alpha[pixel];
      const int k = splat::block_of(x, y);
      const int i = splat::pixel_of(x, y);
      tile.by_red[k][i] = by_colour[0];
      tile.by_green[k][i] = by_colour[1];
      tile.by_blue[k][i] = by_colour[2];
      tile.by_depth[k][i] = by_depth;
      // All that the splats and the background add; alpha is 1 - transmittance.
      tile.rest[k][i] = by_colour[0] * colour[0] + by_colour[1] * colour[1] + by_colour[2] * colour[2] +
                        by_depth * drawn.depth_sum_m[pixel] - by_alpha * (1.0F - drawn.alpha[pixel]);
      tile.transmittance[k][i] = 1.0F;
    }
  }
}

SplatBackward finish(const Splat& s, std::span<const TileSums> parts) {
  float m[kSums] = {};
  for (const TileSums& part : parts) {
    for (int k = 0; k < kSums; ++k) m[k] += part.sums[k];
  }
  // alpha = opacity exp(-(xx dx^2 / 2 + xy dx dy + yy dy^2 / 2)) with dx = x - u.
  return {{s.conic[0] * m[kGx] + s.conic[1] * m[kGy],
           s.conic[1] * m[kGx] + s.conic[2] * m[kGy],
           {-0.5F * m[kGxx], -m[kGxy], -0.5F * m[kGyy]},
           m[kG] / s.opacity,
           {m[kRed], m[kGreen], m[kBlue]},
           m[kDepth]},
          m[kWeight]};
}

}  // namespace

std::span<const SplatBackward> blend_backward(std::span<const Splat> splats, const splat::TileLists& tiles,
                                              const splat::View& view, const Pictures& drawn,
                                              const PictureGradients& by_picture,
                                              BlendBackwardScratch& scratch) {
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  const auto is_picture = [pixels](std::span<const float> values) {
    return values.empty() || values.size() == pixels;
  };
  EDGESPLAT_CHECK(drawn.colour.size() == 3 * pixels && drawn.depth_sum_m.size() == pixels &&
                      drawn.alpha.size() == pixels && by_picture.colour.size() == 3 * pixels &&
                      is_picture(by_picture.depth_sum) && is_picture(by_picture.alpha),
                  "pictures of the view's size");
  scratch.by_slot.resize(tiles.splats.size());
  scratch.by_splat.resize(splats.size());
  const auto reverse_tile = fastest_reverse_tile();
  thread::parallel_for(0, tiles.columns * tiles.rows, [&](int t) {
    const int column = t % tiles.columns;
    const int row = t / tiles.columns;
    Tile tile;
    load_tile(column, row, view, drawn, by_picture, tile);
    reverse_tile({splats, tiles.tile(column, row), tiles.tile_slots(column, row), scratch.by_slot,
                  static_cast<float>(column * kTilePx), static_cast<float>(row * kTilePx)},
                 tile);
  });
  constexpr std::size_t kBlock = 1024;
  thread::parallel_for(std::size_t{0}, (splats.size() + kBlock - 1) / kBlock, [&](std::size_t b) {
    for (std::size_t i = b * kBlock; i < std::min(splats.size(), (b + 1) * kBlock); ++i) {
      const std::size_t first = tiles.splat_starts[i];
      scratch.by_splat[i] =
          finish(splats[i], std::span(scratch.by_slot).subspan(first, tiles.splat_starts[i + 1] - first));
    }
  });
  return scratch.by_splat;
}

}  // namespace edgesplat::train
