// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/blend.hpp"
#include "kernels/splat/exp_fast.hpp"
#include "kernels/splat/splat_one.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

// Inlined into each variant below, which then compiles it for its own vectors.
#define EDGESPLAT_INLINE [[gnu::always_inline]] inline

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
  const float b = s.conic[1] * dy;
  const float c = 0.5F * s.conic[2] * dy * dy;
  for (int x = 0; x < kTilePx; ++x) {
    const float dx = x0_px + static_cast<float>(x) - s.u_px;
    const float power = -(0.5F * s.conic[0] * dx * dx + b * dx + c);
    const float alpha_raw = s.opacity * exp_fast(std::max(std::min(power, 0.0F), -20.0F));
    const float alpha_cut = std::min(alpha_raw, kMaxAlpha);
    const float alpha = alpha_cut < kMinAlpha ? 0.0F : alpha_cut;
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
  constexpr auto kRows = static_cast<float>(kTilePx);
  const auto x0 = static_cast<float>(column * kTilePx);
  const auto y0 = static_cast<float>(row * kTilePx);
  clear(tile);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Splat& s = splats[list[i]];
    // Clamped as floats: a splat may be larger than any int.
    const int first = static_cast<int>(std::clamp(std::ceil(s.v_px - s.half_height_px - y0), 0.0F, kRows));
    const int last =
        static_cast<int>(std::clamp(std::floor(s.v_px + s.half_height_px - y0), -1.0F, kRows - 1));
    for (int y = first; y <= last; ++y) add_to_row(s, x0, y0 + static_cast<float>(y) - s.v_px, y, tile);
    if (i % kCheckEvery == kCheckEvery - 1 && !any_active(tile)) return;
  }
}

using BlendTile = void (*)(std::span<const Splat>, std::span<const std::uint32_t>, int, int, Tile&);

void blend_tile(std::span<const Splat> splats, std::span<const std::uint32_t> list, int column, int row,
                Tile& tile) {
  blend_tile_inline(splats, list, column, row, tile);
}

#if defined(__x86_64__)
#ifdef __clang__  // knows no vector width here and takes 256 bits
#define EDGESPLAT_AVX512 "avx512f,avx512vl,avx512dq,avx512bw"
#else
#define EDGESPLAT_AVX512 "avx512f,avx512vl,avx512dq,avx512bw,prefer-vector-width=512"
#endif
// The same code for wider vectors: the same operations in the same order and no fused multiply-add, so the
// same picture to the last bit.
[[gnu::target("avx2")]] void blend_tile_avx2(std::span<const Splat> splats,
                                             std::span<const std::uint32_t> list, int column, int row,
                                             Tile& tile) {
  blend_tile_inline(splats, list, column, row, tile);
}
[[gnu::target(EDGESPLAT_AVX512)]] void blend_tile_avx512(std::span<const Splat> splats,
                                                         std::span<const std::uint32_t> list, int column,
                                                         int row, Tile& tile) {
  blend_tile_inline(splats, list, column, row, tile);
}
#endif

BlendTile fastest_blend_tile() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")) {
    return blend_tile_avx512;
  }
  if (__builtin_cpu_supports("avx2")) return blend_tile_avx2;
#endif
  return blend_tile;
}

}  // namespace

void blend(std::span<const Splat> splats, const TileLists& tiles, const View& view,
           const RenderOptions& options, const BlendOutputs& out) {
  const BlendTile draw = fastest_blend_tile();
  tbb::parallel_for(0, tiles.columns * tiles.rows, [&](int t) {
    const int column = t % tiles.columns;
    const int row = t / tiles.columns;
    Tile tile;
    draw(splats, tiles.tile(column, row), column, row, tile);
    write_tile(tile, column, row, view, options, out);
  });
}

}  // namespace edgesplat::splat
