// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/blend.hpp"

#include "common/thread/parallel_for.hpp"
#include "kernels/core/simd.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/splat/blend_cpu.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "kernels/splat/lanes-inl.hpp"
#include "kernels/splat/splat_one.hpp"

#include <hwy/highway.h>

#ifndef EDGESPLAT_KERNELS_SPLAT_BLEND_ONCE
#define EDGESPLAT_KERNELS_SPLAT_BLEND_ONCE
namespace edgesplat::splat {

/// Splats of a tile that are taken at once: as many as fit the first cache beside the pixels.
inline constexpr std::size_t kChunk = 256;

/// A tile's accumulators.
struct BlendTile {
  TilePlane transmittance;  ///< under kMinTransmittance once the pixel is full: it only falls
  TilePlane red, green, blue, depth;
  TilePlane weight;  ///< of all the splats that were taken
};

struct BlendScratch {
  TileSplat splats[kChunk];
  /// Which of them reach each block, nearest first.
  std::uint8_t list[kBlocks][kChunk];
  std::uint32_t count[kBlocks];
};

/// Where a tile goes.
struct TileTarget {
  TilePixels place;
  std::array<float, 3> background;
  const BlendOutputs& out;
};

struct BlendTask {
  std::span<const Splat> splats;
  std::span<const TileEntry> list;
  float centre_x_px, centre_y_px;
};

}  // namespace edgesplat::splat
#endif

HWY_BEFORE_NAMESPACE();
namespace edgesplat::splat::HWY_NAMESPACE {

/// Adds the scratch's splats to a block: its pixels stay in registers while the splats go by. `begin`:
/// nothing is there yet. True while some pixel still takes splats.
bool add_to_block(const BlendScratch& scratch, int block, bool begin, BlendTile& tile) {
  const D d;
  const V zero = hn::Zero(d), most = hn::Set(d, kMaxAlpha), least = hn::Set(d, kMinAlpha);
  const V least_left = hn::Set(d, kMinTransmittance);
  bool open = false;
  for (int part = 0; part < kParts; ++part) {
    const PixelPlaces at = places_of(d, block, part);
    const std::size_t first = static_cast<std::size_t>(part * kLanes);
    V left = hn::Set(d, 1.0F), red = zero, green = zero, blue = zero, depth = zero, sum = zero;
    if (!begin) {
      left = hn::Load(d, tile.transmittance.at[block] + first);
      red = hn::Load(d, tile.red.at[block] + first);
      green = hn::Load(d, tile.green.at[block] + first);
      blue = hn::Load(d, tile.blue.at[block] + first);
      depth = hn::Load(d, tile.depth.at[block] + first);
      sum = hn::Load(d, tile.weight.at[block] + first);
    }
    for (std::uint32_t i = 0; i < scratch.count[block]; ++i) {
      const TileSplat& s = scratch.splats[scratch.list[block][i]];
      const V raw = raw_alpha_lanes(d, s, at);
      const V alpha = hn::IfThenElseZero(hn::Ge(raw, least), hn::Min(raw, most));
      const V after = hn::NegMulAdd(alpha, left, left);
      const auto takes = hn::Ge(after, least_left);
      const V weight = hn::IfThenElse(takes, hn::Mul(alpha, left), zero);
      red = hn::MulAdd(weight, hn::Set(d, s.rgb[0]), red);
      green = hn::MulAdd(weight, hn::Set(d, s.rgb[1]), green);
      blue = hn::MulAdd(weight, hn::Set(d, s.rgb[2]), blue);
      depth = hn::MulAdd(weight, hn::Set(d, s.depth_m), depth);
      sum = hn::Add(sum, weight);
      left = after;
    }
    hn::Store(left, d, tile.transmittance.at[block] + first);
    hn::Store(red, d, tile.red.at[block] + first);
    hn::Store(green, d, tile.green.at[block] + first);
    hn::Store(blue, d, tile.blue.at[block] + first);
    hn::Store(depth, d, tile.depth.at[block] + first);
    hn::Store(sum, d, tile.weight.at[block] + first);
    open = open || !hn::AllTrue(d, hn::Lt(left, least_left));
  }
  return open;
}

void blend_tile(const BlendTask& task, BlendScratch& scratch, BlendTile& tile) {
  constexpr std::size_t kAhead = 16;  // a tile's splats lie all over memory
  std::uint32_t open = ~0U >> (32U - kBlocks);
  std::size_t first = 0;
  do {  // once at least: every block is written
    const std::size_t count = std::min(kChunk, task.list.size() - first);
    std::memset(scratch.count, 0, sizeof(scratch.count));
    for (std::size_t i = 0; i < count; ++i) {
      if (first + i + kAhead < task.list.size())
        __builtin_prefetch(&task.splats[task.list[first + i + kAhead].splat]);
      const TileEntry& entry = task.list[first + i];
      set_tile_splat(task.splats[entry.splat], task.centre_x_px, task.centre_y_px, scratch.splats[i]);
      for (std::uint32_t todo = entry.reached & open; todo != 0; todo &= todo - 1) {
        const int block = std::countr_zero(todo);
        scratch.list[block][scratch.count[block]++] = static_cast<std::uint8_t>(i);
      }
    }
    for (std::uint32_t todo = open; todo != 0; todo &= todo - 1) {
      const int block = std::countr_zero(todo);
      if (!add_to_block(scratch, block, first == 0, tile)) open &= ~(1U << static_cast<unsigned>(block));
    }
    first += kChunk;
  } while (first < task.list.size() && open != 0);
}

/// A run of pixels of one row: (x, y) is the first one's place in the tile, of which `load` gets what a plane
/// has there.
template <typename Run, typename Load>
HWY_INLINE void write_run(Run run, const BlendTile& tile, int x, int y, const TileTarget& to,
                          const Load& load) {
  const std::size_t at = to.place.at(x, y);
  const auto alpha = load(tile.weight);
  const auto left = hn::Sub(hn::Set(run, 1.0F), alpha);
  const auto colour = [&](const TilePlane& plane, float background)
                          HWY_ATTR { return hn::MulAdd(left, hn::Set(run, background), load(plane)); };
  hn::StoreInterleaved3(colour(tile.red, to.background[0]), colour(tile.green, to.background[1]),
                        colour(tile.blue, to.background[2]), run, &to.out.colour[3 * at]);
  hn::StoreU(load(tile.depth), run, &to.out.depth_sum_m[at]);
  hn::StoreU(alpha, run, &to.out.alpha[at]);
}

void write_tile(const BlendTile& tile, const TileTarget& to) {
  const hn::CappedTag<float, 1> single;
  for (int y = 0; y < to.place.height_px; ++y) {
    int x = 0;
    for (; x + kLanes <= to.place.width_px; x += kLanes) {
      write_run(D(), tile, x, y, to, [&](const TilePlane& plane) HWY_ATTR {
        return load_row(plane, block_of(x, y), pixel_of(x, y));
      });
    }
    for (; x < to.place.width_px; ++x) {
      write_run(single, tile, x, y, to, [&](const TilePlane& plane) HWY_ATTR {
        return hn::Set(single, plane.at[block_of(x, y)][pixel_of(x, y)]);
      });
    }
  }
}

}  // namespace edgesplat::splat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgesplat::splat {
namespace {

HWY_EXPORT(blend_tile);
HWY_EXPORT(write_tile);

}  // namespace

void blend(std::span<const Splat> splats, const TileLists& tiles, const View& view,
           const RenderOptions& options, const BlendOutputs& out) {
  thread::parallel_for(0, tiles.tiles(), [&](int t) {
    const TilePixels place = tile_pixels(tiles, t, view);
    BlendTile tile;
    BlendScratch scratch;
    HWY_DYNAMIC_DISPATCH(blend_tile)
    ({splats, tiles.tile(t), place.centre_x_px(), place.centre_y_px()}, scratch, tile);
    HWY_DYNAMIC_DISPATCH(write_tile)(tile, {place, options.background, out});
  });
}

}  // namespace edgesplat::splat
#endif
