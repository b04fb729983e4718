// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/blend_backward.hpp"

#include "common/base/check.hpp"
#include "common/thread/parallel_for.hpp"
#include "kernels/core/simd.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/train/blend_backward.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "kernels/core/vectors-inl.hpp"
#include "kernels/splat/lanes-inl.hpp"
#include "kernels/splat/splat_one.hpp"

#include <hwy/highway.h>

#ifndef EDGESPLAT_KERNELS_TRAIN_BLEND_BACKWARD_ONCE
#define EDGESPLAT_KERNELS_TRAIN_BLEND_BACKWARD_ONCE
namespace edgesplat::train {

/// A tile's pixels.
struct ReverseTile {
  splat::TilePlane transmittance;  ///< under kMinTransmittance once the pixel is full: it only falls
  /// dL by picture times what the splats still to come and the background add.
  splat::TilePlane rest;
  splat::TilePlane by_red, by_green, by_blue, by_depth;
};

/// Sums over the pixels of one tile for one splat: moments about the tile's centre of g, dL by the exponent
/// of its falloff, and dL by what it adds.
enum Sum { kG, kGx, kGy, kGxx, kGxy, kGyy, kRed, kGreen, kBlue, kDepth, kWeight, kUsed, kSums = 16 };

/// Where a tile's pixels come from.
struct TileSource {
  splat::TilePixels place;
  const Pictures& drawn;
  const PictureGradients& by_picture;
};

struct ReverseTask {
  std::span<const splat::Splat> splats;
  std::span<const splat::TileEntry> list;
  std::span<TileSums> by_slot;
  float centre_x_px, centre_y_px;
};

}  // namespace edgesplat::train
#endif

HWY_BEFORE_NAMESPACE();
namespace edgesplat::train::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using splat::HWY_NAMESPACE::D;
using splat::HWY_NAMESPACE::kLanes;
using splat::HWY_NAMESPACE::kParts;
using splat::HWY_NAMESPACE::V;

/// Place by place in a register, to be added up when all blocks are through.
struct LaneSums {
  V g, gx, gy, gxx, gxy, gyy, red, green, blue, depth, weight;
};

/// One splat on a block. With T the transmittance before it, q = dL by picture times what it would add at
/// weight 1, R the rest behind it: dL/dalpha = T q - R / (1 - alpha).
HWY_INLINE void add_block(const splat::TileSplat& s, int block, ReverseTile& tile, LaneSums& sums) {
  const D d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  const V most = hn::Set(d, splat::kMaxAlpha), least = hn::Set(d, splat::kMinAlpha);
  const V least_left = hn::Set(d, splat::kMinTransmittance);
  for (int part = 0; part < kParts; ++part) {
    const auto at = splat::HWY_NAMESPACE::places_of(d, block, part);
    const std::size_t first = static_cast<std::size_t>(part * kLanes);
    const V raw = splat::HWY_NAMESPACE::raw_alpha_lanes(d, s, at);
    const V alpha = hn::IfThenElseZero(hn::Ge(raw, least), hn::Min(raw, most));
    const V before = hn::Load(d, tile.transmittance.at[block] + first);
    const V after = hn::NegMulAdd(alpha, before, before);
    const auto takes = hn::Ge(after, least_left);
    const V weight = hn::IfThenElse(takes, hn::Mul(alpha, before), zero);
    const V by_red = hn::Load(d, tile.by_red.at[block] + first);
    const V by_green = hn::Load(d, tile.by_green.at[block] + first);
    const V by_blue = hn::Load(d, tile.by_blue.at[block] + first);
    const V by_depth = hn::Load(d, tile.by_depth.at[block] + first);
    V q = hn::Mul(by_red, hn::Set(d, s.rgb[0]));
    q = hn::MulAdd(by_green, hn::Set(d, s.rgb[1]), q);
    q = hn::MulAdd(by_blue, hn::Set(d, s.rgb[2]), q);
    q = hn::MulAdd(by_depth, hn::Set(d, s.depth_m), q);
    const V rest = hn::NegMulAdd(weight, q, hn::Load(d, tile.rest.at[block] + first));
    const V by_alpha =
        hn::NegMulAdd(rest, core::HWY_NAMESPACE::reciprocal(d, hn::Sub(one, alpha)), hn::Mul(before, q));
    // alpha is 0 where it is skipped and constant where it is cut.
    const V g = hn::IfThenElseZero(hn::And(takes, hn::Lt(raw, most)), hn::Mul(alpha, by_alpha));
    sums.g = hn::Add(sums.g, g);
    sums.gx = hn::MulAdd(g, at.x, sums.gx);
    sums.gy = hn::MulAdd(g, at.y, sums.gy);
    sums.gxx = hn::MulAdd(g, at.xx, sums.gxx);
    sums.gxy = hn::MulAdd(g, at.xy, sums.gxy);
    sums.gyy = hn::MulAdd(g, at.yy, sums.gyy);
    sums.red = hn::MulAdd(weight, by_red, sums.red);
    sums.green = hn::MulAdd(weight, by_green, sums.green);
    sums.blue = hn::MulAdd(weight, by_blue, sums.blue);
    sums.depth = hn::MulAdd(weight, by_depth, sums.depth);
    sums.weight = hn::Add(sums.weight, weight);
    hn::Store(rest, d, tile.rest.at[block] + first);
    hn::Store(after, d, tile.transmittance.at[block] + first);
  }
}

/// Four sums of a register each: across each quarter by interleaving, then quarter onto quarter.
HWY_INLINE void sum_four(V a, V b, V c, V e, float* out) {
#if HWY_TARGET == HWY_SCALAR
  out[0] = hn::GetLane(a), out[1] = hn::GetLane(b), out[2] = hn::GetLane(c), out[3] = hn::GetLane(e);
#else
  const D d;
  const hn::RepartitionToWide<D> wide;
  const V ab = hn::Add(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b));
  const V ce = hn::Add(hn::InterleaveLower(d, c, e), hn::InterleaveUpper(d, c, e));
  const auto wide_ab = hn::BitCast(wide, ab), wide_ce = hn::BitCast(wide, ce);
  const V all = hn::Add(hn::BitCast(d, hn::InterleaveLower(wide, wide_ab, wide_ce)),
                        hn::BitCast(d, hn::InterleaveUpper(wide, wide_ab, wide_ce)));
  const hn::CappedTag<float, 4> quarter;
#if HWY_TARGET <= HWY_AVX3
  const hn::Half<D> half;
  const hn::Half<decltype(half)> last;
  const auto halves = hn::Add(hn::LowerHalf(half, all), hn::UpperHalf(half, all));
  hn::StoreU(hn::Add(hn::LowerHalf(last, halves), hn::UpperHalf(last, halves)), quarter, out);
#elif HWY_TARGET <= HWY_AVX2
  const hn::Half<D> half;
  hn::StoreU(hn::Add(hn::LowerHalf(half, all), hn::UpperHalf(half, all)), quarter, out);
#else
  hn::StoreU(all, quarter, out);
#endif
#endif
}

HWY_INLINE void add_up(const LaneSums& lanes, TileSums& out) {
  sum_four(lanes.g, lanes.gx, lanes.gy, lanes.gxx, out.sums + kG);
  sum_four(lanes.gxy, lanes.gyy, lanes.red, lanes.green, out.sums + kGxy);
  sum_four(lanes.blue, lanes.depth, lanes.weight, hn::Zero(D()), out.sums + kBlue);
}

/// From moments about the tile's centre to those about the splat's, which lies at (u, v) from it.
HWY_INLINE void recentre(float u, float v, TileSums& out) {
  float* m = out.sums;
  m[kGxx] += u * (u * m[kG] - 2.0F * m[kGx]);
  m[kGxy] += u * v * m[kG] - u * m[kGy] - v * m[kGx];
  m[kGyy] += v * (v * m[kG] - 2.0F * m[kGy]);
  m[kGx] -= u * m[kG];
  m[kGy] -= v * m[kG];
}

/// A run of pixels of one row before the first splat: (x, y) is the first one's place in the tile, where
/// `store` puts what a plane has there.
template <typename Run, typename Store>
HWY_INLINE void load_run(Run run, const TileSource& from, int x, int y, ReverseTile& tile,
                         const Store& store) {
  using R = hn::Vec<Run>;
  const std::size_t at = from.place.at(x, y);
  const auto value_of = [&](std::span<const float> picture) HWY_ATTR {
    return picture.empty() ? hn::Zero(run) : hn::LoadU(run, &picture[at]);
  };
  R by_red, by_green, by_blue, red, green, blue;
  hn::LoadInterleaved3(run, &from.by_picture.colour[3 * at], by_red, by_green, by_blue);
  hn::LoadInterleaved3(run, &from.drawn.colour[3 * at], red, green, blue);
  const R by_depth = value_of(from.by_picture.depth_sum);
  const R seen_through = hn::Sub(hn::Set(run, 1.0F), hn::LoadU(run, &from.drawn.alpha[at]));
  // All that the splats and the background add; alpha is 1 - transmittance.
  R rest = hn::Mul(by_red, red);
  rest = hn::MulAdd(by_green, green, rest);
  rest = hn::MulAdd(by_blue, blue, rest);
  rest = hn::MulAdd(by_depth, hn::LoadU(run, &from.drawn.depth_sum_m[at]), rest);
  rest = hn::NegMulAdd(value_of(from.by_picture.alpha), seen_through, rest);
  store(by_red, tile.by_red);
  store(by_green, tile.by_green);
  store(by_blue, tile.by_blue);
  store(by_depth, tile.by_depth);
  store(rest, tile.rest);
  store(hn::Set(run, 1.0F), tile.transmittance);
}

/// Pixels beyond the picture's edge are full from the start.
void load_tile(const TileSource& from, ReverseTile& tile) {
  const hn::CappedTag<float, 1> single;
  const splat::TilePixels& place = from.place;
  if (place.width_px < splat::kTileWidthPx || place.height_px < splat::kTileHeightPx) tile = {};
  for (int y = 0; y < place.height_px; ++y) {
    int x = 0;
    for (; x + kLanes <= place.width_px; x += kLanes) {
      load_run(D(), from, x, y, tile, [&](V values, splat::TilePlane& plane) HWY_ATTR {
        splat::HWY_NAMESPACE::store_row(values, plane, splat::block_of(x, y), splat::pixel_of(x, y));
      });
    }
    for (; x < place.width_px; ++x) {
      load_run(single, from, x, y, tile,
               [&](hn::Vec<decltype(single)> value, splat::TilePlane& plane)
                   HWY_ATTR { plane.at[splat::block_of(x, y)][splat::pixel_of(x, y)] = hn::GetLane(value); });
    }
  }
}

/// Bit b is set where some pixel of block b still takes splats.
std::uint32_t open_blocks(const splat::TilePlane& transmittance) {
  const D d;
  std::uint32_t blocks = 0;
  for (unsigned b = 0; b < splat::kBlocks; ++b) {
    for (int part = 0; part < kParts; ++part) {
      const V left = hn::Load(d, transmittance.at[b] + static_cast<std::size_t>(part * kLanes));
      if (!hn::AllTrue(d, hn::Lt(left, hn::Set(d, splat::kMinTransmittance)))) blocks |= 1U << b;
    }
  }
  return blocks;
}

void reverse_tile(const ReverseTask& task, ReverseTile& tile) {
  constexpr std::size_t kCheckEvery = 16;  // looking which blocks are full costs about one splat
  constexpr std::size_t kAhead = 8;        // a tile's splats lie all over memory
  const V zero = hn::Zero(D());
  std::uint32_t open = open_blocks(tile.transmittance);
  std::size_t i = 0;
  for (; i < task.list.size() && open != 0; ++i) {
    if (i + kAhead < task.list.size()) {
      __builtin_prefetch(&task.splats[task.list[i + kAhead].splat]);
      __builtin_prefetch(&task.by_slot[task.list[i + kAhead].slot], 1);
    }
    const splat::Splat& source = task.splats[task.list[i].splat];
    splat::TileSplat s;
    splat::set_tile_splat(source, task.centre_x_px, task.centre_y_px, s);
    LaneSums sums = {zero, zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
    for (std::uint32_t todo = task.list[i].reached & open; todo != 0; todo &= todo - 1)
      add_block(s, std::countr_zero(todo), tile, sums);
    TileSums& out = task.by_slot[task.list[i].slot];
    add_up(sums, out);
    recentre(source.u_px - task.centre_x_px, source.v_px - task.centre_y_px, out);
    if (i % kCheckEvery == kCheckEvery - 1) open = open_blocks(tile.transmittance);
  }
  for (; i < task.list.size(); ++i) task.by_slot[task.list[i].slot] = {};
}

HWY_INLINE void finish(const splat::Splat& s, std::span<const TileSums> parts, SplatBackward& out) {
  const D d;
  alignas(64) float m[kSums];
  for (int k = 0; k < kSums; k += kLanes) {
    V sum = hn::Zero(d);
    for (const TileSums& part : parts) sum = hn::Add(sum, hn::Load(d, part.sums + k));
    hn::Store(sum, d, m + k);
  }
  // alpha = opacity exp(-(xx dx^2 / 2 + xy dx dy + yy dy^2 / 2)) with dx = x - u.
  out.by_u = s.conic[0] * m[kGx] + s.conic[1] * m[kGy];
  out.by_v = s.conic[1] * m[kGx] + s.conic[2] * m[kGy];
  out.by_conic[0] = -0.5F * m[kGxx];
  out.by_conic[1] = -m[kGxy];
  out.by_conic[2] = -0.5F * m[kGyy];
  out.by_log_opacity = m[kG];
  for (int c = 0; c < 3; ++c) {
    out.by_rgb[c] = s.rgb[c] > 0.0F ? m[kRed + c] : 0.0F;
    out.conic[c] = s.conic[c];
  }
  out.by_depth = m[kDepth];
  out.radius_px = std::max(s.half_width_px, s.half_height_px);
  out.weight = m[kWeight];
  out.gaussian = s.gaussian;
}

/// Adds up what the tiles left of splats [first, last); returns how many of them have a weight.
std::size_t finish_splats(std::span<const splat::Splat> splats, const splat::TileLists& tiles,
                          std::size_t first, std::size_t last, BlendBackwardScratch& scratch) {
  std::size_t seen = 0;
  for (std::size_t i = first; i < last; ++i) {
    const std::size_t slot = tiles.splat_starts[i];
    SplatBackward& out = scratch.by_row[splats[i].order];
    finish(splats[i], std::span(scratch.by_slot).subspan(slot, tiles.splat_starts[i + 1] - slot), out);
    seen += out.weight > 0.0F ? 1 : 0;
  }
  return seen;
}

}  // namespace edgesplat::train::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgesplat::train {
namespace {

HWY_EXPORT(load_tile);
HWY_EXPORT(reverse_tile);
HWY_EXPORT(finish_splats);

using splat::Splat;

}  // namespace

BlendGradients blend_backward(std::span<const Splat> splats, const splat::TileLists& tiles,
                              const splat::View& view, const Pictures& drawn,
                              const PictureGradients& by_picture, BlendBackwardScratch& scratch) {
  const auto pixels = static_cast<std::size_t>(view.width_px) * static_cast<std::size_t>(view.height_px);
  const auto is_picture = [pixels](std::span<const float> values) {
    return values.empty() || values.size() == pixels;
  };
  EDGESPLAT_CHECK(drawn.colour.size() == 3 * pixels && drawn.depth_sum_m.size() == pixels &&
                      drawn.alpha.size() == pixels && by_picture.colour.size() == 3 * pixels &&
                      is_picture(by_picture.depth_sum) && is_picture(by_picture.alpha),
                  "pictures of the view's size");
  scratch.by_slot.resize(tiles.entries.size());
  scratch.by_row.resize(splats.size());
  thread::parallel_for(0, tiles.tiles(), [&](int t) {
    const splat::TilePixels place = splat::tile_pixels(tiles, t, view);
    ReverseTile tile;
    HWY_DYNAMIC_DISPATCH(load_tile)({place, drawn, by_picture}, tile);
    HWY_DYNAMIC_DISPATCH(reverse_tile)
    ({splats, tiles.tile(t), scratch.by_slot, place.centre_x_px(), place.centre_y_px()}, tile);
  });
  constexpr std::size_t kBlock = 1024;
  std::vector<std::size_t> seen((splats.size() + kBlock - 1) / kBlock, 0);
  thread::parallel_for(std::size_t{0}, seen.size(), [&](std::size_t b) {
    seen[b] = HWY_DYNAMIC_DISPATCH(finish_splats)(splats, tiles, b * kBlock,
                                                  std::min(splats.size(), (b + 1) * kBlock), scratch);
  });
  return {scratch.by_row, std::accumulate(seen.begin(), seen.end(), std::size_t{0})};
}

}  // namespace edgesplat::train
#endif
