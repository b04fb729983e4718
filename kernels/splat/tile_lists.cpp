// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/tile_lists.hpp"

#include "common/thread/parallel_for.hpp"
#include "kernels/core/simd.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/splat/tile_lists.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "kernels/splat/lanes-inl.hpp"

#include <hwy/highway.h>

#ifndef EDGESPLAT_KERNELS_SPLAT_TILE_LISTS_ONCE
#define EDGESPLAT_KERNELS_SPLAT_TILE_LISTS_ONCE
namespace edgesplat::splat {

struct TileRange {
  int first, last;  ///< [first, last)
};

inline TileRange tiles_touched(float centre_px, float half_px, int tile_px, int tiles) {
  const auto clamp_tile = [tile_px, tiles](float px) {
    return static_cast<int>(std::clamp(px / static_cast<float>(tile_px), -1.0F, static_cast<float>(tiles)));
  };
  // Tile t covers pixel centres [n t, n t + n - 1], so edges half a pixel outside of them.
  const float low = centre_px - half_px + 0.5F;
  const float high = centre_px + half_px + 0.5F;
  return {std::max(0, low < 0 ? 0 : clamp_tile(low)), high < 0 ? 0 : std::min(tiles, clamp_tile(high) + 1)};
}

/// First pixels of the blocks of a tile.
struct BlockCorners {
  alignas(64) float x[kBlocks];
  alignas(64) float y[kBlocks];
};
constexpr BlockCorners block_corners() {
  BlockCorners corners{};
  for (int b = 0; b < kBlocks; ++b) {
    corners.x[b] = static_cast<float>(b % kBlockColumns * kBlockPx);
    corners.y[b] = static_cast<float>(b / kBlockColumns * kBlockPx);
  }
  return corners;
}
inline constexpr BlockCorners kBlockCorners = block_corners();

}  // namespace edgesplat::splat
#endif

HWY_BEFORE_NAMESPACE();
namespace edgesplat::splat::HWY_NAMESPACE {

/// Bit b is set where alpha may reach 1/255 in block b of the tile whose first pixel lies at (left, top) from
/// the splat's centre: smallest value of the splat's quadratic form over the block's pixel centres. It is
/// convex, so its minimum over a rectangle lies at the point nearest to the centre in x or in y, the other
/// coordinate being free.
HWY_INLINE std::uint32_t blocks_reached(const Splat& s, float left, float top) {
  const D d;
  const V span = hn::Set(d, static_cast<float>(kBlockPx - 1)), zero = hn::Zero(d);
  const V a = hn::Set(d, s.conic[0]), b2 = hn::Set(d, 2.0F * s.conic[1]), c = hn::Set(d, s.conic[2]);
  const V slope_y = hn::Set(d, -s.conic[1] / s.conic[2]), slope_x = hn::Set(d, -s.conic[1] / s.conic[0]);
  // A hair more than the blend's own threshold, so that rounding never loses a pixel.
  const V reach2 = hn::Set(d, s.reach2 * 1.0001F + 1e-4F);
  std::uint32_t reached = 0;
  for (std::size_t first = 0; first < kBlocks; first += kLanes) {
    const V x_low = hn::Add(hn::Set(d, left), hn::Load(d, kBlockCorners.x + first));
    const V y_low = hn::Add(hn::Set(d, top), hn::Load(d, kBlockCorners.y + first));
    const V x_high = hn::Add(x_low, span), y_high = hn::Add(y_low, span);
    const V x = hn::Min(hn::Max(zero, x_low), x_high), y = hn::Min(hn::Max(zero, y_low), y_high);
    const V y_of_x = hn::Min(hn::Max(hn::Mul(slope_y, x), y_low), y_high);
    const V x_of_y = hn::Min(hn::Max(hn::Mul(slope_x, y), x_low), x_high);
    const V at_x = hn::MulAdd(hn::MulAdd(b2, x, hn::Mul(c, y_of_x)), y_of_x, hn::Mul(hn::Mul(a, x), x));
    const V at_y = hn::MulAdd(hn::MulAdd(b2, y, hn::Mul(a, x_of_y)), x_of_y, hn::Mul(hn::Mul(c, y), y));
    // What is not a number counts as reached.
    const auto out = hn::Gt(hn::Min(at_x, at_y), reach2);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Not(out), bits);
    reached |= (static_cast<std::uint32_t>(bits[0]) | static_cast<std::uint32_t>(bits[1]) << 8U) << first;
  }
  return reached;
}

void find_tiles(std::span<const Splat> splats, int columns, int rows, TilePart& part) {
  part.places.assign(static_cast<std::size_t>(columns * rows), 0);
  part.tiles.clear();
  part.reached.clear();
  part.counts.clear();
  part.counts.reserve(part.last - part.first);
  for (std::size_t i = part.first; i < part.last; ++i) {
    const Splat& s = splats[i];
    const TileRange across = tiles_touched(s.u_px, s.half_width_px, kTileWidthPx, columns);
    const TileRange down = tiles_touched(s.v_px, s.half_height_px, kTileHeightPx, rows);
    const std::size_t before = part.tiles.size();
    for (int row = down.first; row < down.last; ++row) {
      for (int column = across.first; column < across.last; ++column) {
        const std::uint32_t reached = blocks_reached(s, static_cast<float>(column * kTileWidthPx) - s.u_px,
                                                     static_cast<float>(row * kTileHeightPx) - s.v_px);
        if (reached == 0) continue;
        const auto tile = static_cast<std::uint32_t>(row * columns + column);
        part.tiles.push_back(tile);
        part.reached.push_back(reached);
        ++part.places[tile];
      }
    }
    part.counts.push_back(static_cast<std::uint32_t>(part.tiles.size() - before));
  }
}

}  // namespace edgesplat::splat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgesplat::splat {
namespace {

HWY_EXPORT(find_tiles);

/// Splats are dealt out in this many runs whatever the number of threads; the result does not depend on it.
constexpr std::size_t kRuns = 32;

/// Fills lists.starts and turns the counts per part and tile into places: tile by tile, in each tile part by
/// part, so that a tile keeps the order of the splats.
void lay_out(std::vector<TilePart>& parts, TileLists& lists) {
  const auto tiles = static_cast<std::size_t>(lists.columns * lists.rows);
  lists.starts.resize(tiles + 1);
  std::uint32_t next = 0;
  for (std::size_t t = 0; t < tiles; ++t) {
    lists.starts[t] = next;
    for (TilePart& part : parts) next += std::exchange(part.places[t], next);
  }
  lists.starts[tiles] = next;
  lists.entries.resize(next);
}

void number_slots(const std::vector<TilePart>& parts, TileLists& lists) {
  lists.splat_starts.clear();
  std::uint32_t next = 0;
  for (const TilePart& part : parts) {
    for (const std::uint32_t count : part.counts) {
      lists.splat_starts.push_back(next);
      next += count;
    }
  }
  lists.splat_starts.push_back(next);
}

void deal_out(TilePart& part, TileLists& lists) {
  std::uint32_t slot = lists.splat_starts[part.first];
  std::size_t entry = 0;
  for (std::size_t i = part.first; i < part.last; ++i) {
    for (std::uint32_t k = 0; k < part.counts[i - part.first]; ++k, ++entry, ++slot) {
      lists.entries[part.places[part.tiles[entry]]++] = {static_cast<std::uint32_t>(i), slot,
                                                         part.reached[entry]};
    }
  }
}

}  // namespace

void make_tile_lists(std::span<const Splat> splats, int width_px, int height_px, TileListsScratch& scratch,
                     TileLists& out) {
  out.columns = (width_px + kTileWidthPx - 1) / kTileWidthPx;
  out.rows = (height_px + kTileHeightPx - 1) / kTileHeightPx;
  std::vector<TilePart>& parts = scratch.parts;
  parts.resize(kRuns);
  thread::parallel_for(std::size_t{0}, kRuns, [&](std::size_t p) {
    parts[p].first = splats.size() * p / kRuns;
    parts[p].last = splats.size() * (p + 1) / kRuns;
    HWY_DYNAMIC_DISPATCH(find_tiles)(splats, out.columns, out.rows, parts[p]);
  });
  out.splat_starts.reserve(splats.size() + 1);
  number_slots(parts, out);
  lay_out(parts, out);
  thread::parallel_for(std::size_t{0}, kRuns, [&](std::size_t p) { deal_out(parts[p], out); });
}

TileLists make_tile_lists(std::span<const Splat> splats, int width_px, int height_px) {
  TileListsScratch scratch;
  TileLists lists;
  make_tile_lists(splats, width_px, height_px, scratch, lists);
  return lists;
}

}  // namespace edgesplat::splat
#endif
