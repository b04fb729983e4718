// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/blend_backward.hpp"

#include "common/base/check.hpp"
#include "kernels/core/simd_variants.hpp"
#include "kernels/splat/pixel_alpha.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace edgesplat::train {
namespace {

using splat::kTilePx;
using splat::Splat;

using Plane = float[kTilePx][kTilePx];

/// A tile's pixels, channel by channel so that a row of 16 is a vector.
struct Tile {
  Plane transmittance;
  Plane active;  ///< 1 until the pixel is full, then 0
  Plane rest;    ///< dL by picture times what the splats still to come and the background add to it
  Plane by_red, by_green, by_blue, by_depth;
};

/// Sums over the pixels of one tile for one splat. g is dL by the exponent of the splat's falloff.
enum Sum { kG, kGdy, kGdy2, kRed, kGreen, kBlue, kDepth, kWeight, kColumnSums };
using ColumnSums = float[kColumnSums][kTilePx];

/// The same after the columns: moments of g about the splat's centre.
struct Moments {
  float g, gx, gy, gxx, gxy, gyy;
  float red, green, blue, depth, weight;
};

/// One splat on one row of pixels. With T the transmittance before it, q = dL by picture times what it would
/// add at weight 1, R the rest behind it: dL/dalpha = T q - R / (1 - alpha).
EDGESPLAT_INLINE void add_row(const Splat s, float x0_px, float dy, int y, Tile& tile, ColumnSums& sums) {
  const splat::RowOfSplat row = splat::row_of(s, dy);
  const float dy2 = dy * dy;
  for (int x = 0; x < kTilePx; ++x) {
    const float raw = splat::raw_alpha(s.opacity, row, x0_px + static_cast<float>(x) - s.u_px);
    const float alpha = splat::blended_alpha(raw);
    const float before = tile.transmittance[y][x];
    const float after = before * (1.0F - alpha);
    const float active = after >= splat::kMinTransmittance ? tile.active[y][x] : 0.0F;
    const float weight = active * alpha * before;
    const float q = tile.by_red[y][x] * s.rgb[0] + tile.by_green[y][x] * s.rgb[1] +
                    tile.by_blue[y][x] * s.rgb[2] + tile.by_depth[y][x] * s.depth_m;
    const float rest = tile.rest[y][x] - weight * q;
    const float by_alpha = before * q - rest / (1.0F - alpha);
    // alpha is 0 where it is skipped and constant where it is cut.
    const float g = (raw < splat::kMaxAlpha ? active : 0.0F) * alpha * by_alpha;
    sums[kG][x] += g;
    sums[kGdy][x] += g * dy;
    sums[kGdy2][x] += g * dy2;
    sums[kRed][x] += weight * tile.by_red[y][x];
    sums[kGreen][x] += weight * tile.by_green[y][x];
    sums[kBlue][x] += weight * tile.by_blue[y][x];
    sums[kDepth][x] += weight * tile.by_depth[y][x];
    sums[kWeight][x] += weight;
    tile.rest[y][x] = rest;
    tile.transmittance[y][x] = active > 0.0F ? after : before;
    tile.active[y][x] = active;
  }
}

/// Always in the same order: halves onto halves.
EDGESPLAT_INLINE float sum_of(const float* values) {
  float half[8];
  for (int i = 0; i < 8; ++i) half[i] = values[i] + values[i + 8];
  float quarter[4];
  for (int i = 0; i < 4; ++i) quarter[i] = half[i] + half[i + 4];
  return (quarter[0] + quarter[2]) + (quarter[1] + quarter[3]);
}

EDGESPLAT_INLINE Moments moments_of(const ColumnSums& sums, float x0_minus_u_px) {
  float gx[kTilePx], gxx[kTilePx], gxy[kTilePx];
  for (int x = 0; x < kTilePx; ++x) {
    const float dx = x0_minus_u_px + static_cast<float>(x);
    gx[x] = sums[kG][x] * dx;
    gxx[x] = gx[x] * dx;
    gxy[x] = sums[kGdy][x] * dx;
  }
  return {sum_of(sums[kG]),    sum_of(gx),           sum_of(sums[kGdy]),   sum_of(gxx),
          sum_of(gxy),         sum_of(sums[kGdy2]),  sum_of(sums[kRed]),   sum_of(sums[kGreen]),
          sum_of(sums[kBlue]), sum_of(sums[kDepth]), sum_of(sums[kWeight])};
}

EDGESPLAT_INLINE bool any_active(const Tile& tile) {
  float sum = 0.0F;
  for (const auto& row : tile.active) {
    for (const float active : row) sum += active;
  }
  return sum > 0.0F;
}

struct TileTask {
  std::span<const Splat> splats;
  std::span<const std::uint32_t> list;
  std::span<const std::uint32_t> slots;
  std::span<Moments> moments;  ///< by slot, zero on entry
  float x0_px, y0_px;
};

EDGESPLAT_INLINE void reverse_tile_inline(const TileTask& task, Tile& tile) {
  constexpr std::size_t kCheckEvery = 16;
  for (std::size_t i = 0; i < task.list.size(); ++i) {
    if (i + splat::kPrefetchAhead < task.list.size()) {
      splat::prefetch(task.splats[task.list[i + splat::kPrefetchAhead]]);
      __builtin_prefetch(&task.moments[task.slots[i + splat::kPrefetchAhead]], 1);
      __builtin_prefetch(&task.moments[task.slots[i + splat::kPrefetchAhead]].weight, 1);
    }
    const Splat& s = task.splats[task.list[i]];
    const splat::TileRows rows = splat::rows_reached(s, task.y0_px);
    ColumnSums sums = {};
    for (int y = rows.first; y <= rows.last; ++y) {
      add_row(s, task.x0_px, task.y0_px + static_cast<float>(y) - s.v_px, y, tile, sums);
    }
    task.moments[task.slots[i]] = moments_of(sums, task.x0_px - s.u_px);
    if (i % kCheckEvery == kCheckEvery - 1 && !any_active(tile)) return;
  }
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
      tile.by_red[y][x] = by_colour[0];
      tile.by_green[y][x] = by_colour[1];
      tile.by_blue[y][x] = by_colour[2];
      tile.by_depth[y][x] = by_depth;
      // All that the splats and the background add; alpha is 1 - transmittance.
      tile.rest[y][x] = by_colour[0] * colour[0] + by_colour[1] * colour[1] + by_colour[2] * colour[2] +
                        by_depth * drawn.depth_sum_m[pixel] - by_alpha * (1.0F - drawn.alpha[pixel]);
      tile.transmittance[y][x] = 1.0F;
      tile.active[y][x] = 1.0F;
    }
  }
}

SplatBackward finish(const Splat& s, std::span<const Moments> moments) {
  Moments m{};
  for (const Moments& part : moments) {
    m.g += part.g;
    m.gx += part.gx;
    m.gy += part.gy;
    m.gxx += part.gxx;
    m.gxy += part.gxy;
    m.gyy += part.gyy;
    m.red += part.red;
    m.green += part.green;
    m.blue += part.blue;
    m.depth += part.depth;
    m.weight += part.weight;
  }
  // power = -(xx dx^2 / 2 + xy dx dy + yy dy^2 / 2) with dx = x - u; alpha = opacity exp(power).
  return {{s.conic[0] * m.gx + s.conic[1] * m.gy,
           s.conic[1] * m.gx + s.conic[2] * m.gy,
           {-0.5F * m.gxx, -m.gxy, -0.5F * m.gyy},
           m.g / s.opacity,
           {m.red, m.green, m.blue},
           m.depth},
          m.weight};
}

}  // namespace

std::vector<SplatBackward> blend_backward(std::span<const Splat> splats, const splat::TileLists& tiles,
                                          const splat::View& view, const Pictures& drawn,
                                          const PictureGradients& by_picture) {
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  const auto is_picture = [pixels](std::span<const float> values) {
    return values.empty() || values.size() == pixels;
  };
  EDGESPLAT_CHECK(drawn.colour.size() == 3 * pixels && drawn.depth_sum_m.size() == pixels &&
                      drawn.alpha.size() == pixels && by_picture.colour.size() == 3 * pixels &&
                      is_picture(by_picture.depth_sum) && is_picture(by_picture.alpha),
                  "pictures of the view's size");
  std::vector<Moments> moments(tiles.splats.size());
  const auto reverse_tile = fastest_reverse_tile();
  tbb::parallel_for(0, tiles.columns * tiles.rows, [&](int t) {
    const int column = t % tiles.columns;
    const int row = t / tiles.columns;
    Tile tile;
    load_tile(column, row, view, drawn, by_picture, tile);
    reverse_tile({splats, tiles.tile(column, row), tiles.tile_slots(column, row), moments,
                  static_cast<float>(column * kTilePx), static_cast<float>(row * kTilePx)},
                 tile);
  });
  std::vector<SplatBackward> out(splats.size());
  tbb::parallel_for(std::size_t{0}, splats.size(), [&](std::size_t i) {
    const std::size_t first = tiles.splat_starts[i];
    out[i] = finish(splats[i], std::span(moments).subspan(first, tiles.splat_starts[i + 1] - first));
  });
  return out;
}

}  // namespace edgesplat::train
