// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0

// What several Highway loops over pixels share; compiled once for each set of vector instructions, so the
// guard is a toggle (see Highway's documentation on -inl.h files).
#if defined(EDGESPLAT_KERNELS_SPLAT_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGESPLAT_KERNELS_SPLAT_LANES_INL_HPP
#undef EDGESPLAT_KERNELS_SPLAT_LANES_INL_HPP
#else
#define EDGESPLAT_KERNELS_SPLAT_LANES_INL_HPP
#endif

#include "kernels/splat/tile_blocks.hpp"
#include "kernels/splat/tile_splat.hpp"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace edgesplat::splat::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A register of at most a block of pixels.
using D = hn::CappedTag<float, kBlockPixels>;
using V = hn::Vec<D>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(D()));
/// Registers that make up a block.
constexpr int kParts = kBlockPixels / kLanes;

/// 2^x, relative error under 3e-6; 0 or next to it for x below -100. All registers of one machine compute the
/// same, so forward and backward passes agree to the last bit; machines of different kinds agree to rounding.
HWY_INLINE V exp2_lanes(D d, V x) {
#if HWY_TARGET == HWY_AVX3
  constexpr int kDown = 1, kQuietly = 8;
  const V f{_mm512_reduce_ps(x.raw, kDown | kQuietly)};  // x - floor(x)
  V p = hn::MulAdd(f, hn::Set(d, 0.0135341678F), hn::Set(d, 0.0520114601F));
  p = hn::MulAdd(p, f, hn::Set(d, 0.241442755F));
  p = hn::MulAdd(p, f, hn::Set(d, 0.693003833F));
  p = hn::MulAdd(p, f, hn::Set(d, 1.00000262F));
  return V{_mm512_scalef_ps(p.raw, x.raw)};  // p 2^floor(x)
#else
  const hn::RebindToSigned<D> di;
  x = hn::Max(x, hn::Set(d, -100.0F));
  const V magic = hn::Set(d, 12582912.0F);  // 1.5 * 2^23: rounds to the nearest integer in the low bits
  const V shifted = hn::Add(x, magic);
  const V f = hn::Sub(x, hn::Sub(shifted, magic));
  V p = hn::MulAdd(f, hn::Set(d, 0.00957010221F), hn::Set(d, 0.0559178628F));
  p = hn::MulAdd(p, f, hn::Set(d, 0.240247443F));
  p = hn::MulAdd(p, f, hn::Set(d, 0.693121791F));
  p = hn::MulAdd(p, f, hn::Set(d, 0.999999284F));
  return hn::BitCast(d, hn::Add(hn::BitCast(di, p), hn::ShiftLeft<23>(hn::BitCast(di, shifted))));
#endif
}

/// Where the pixels of a register lie in their tile, from its centre: x, y, x^2, x y, y^2.
struct PixelPlaces {
  V x, y, xx, xy, yy;
};
HWY_INLINE PixelPlaces places_of(D d, int block, int part) {
  const std::size_t first = static_cast<std::size_t>(part * kLanes);
  return {hn::Load(d, kTilePlaces.x.at[block] + first), hn::Load(d, kTilePlaces.y.at[block] + first),
          hn::Load(d, kTilePlaces.xx.at[block] + first), hn::Load(d, kTilePlaces.xy.at[block] + first),
          hn::Load(d, kTilePlaces.yy.at[block] + first)};
}

/// Opacity times falloff of one splat at the pixels of a register, before it is cut at kMaxAlpha and dropped
/// under kMinAlpha. The forward and the backward pass must take the same decisions, so both ask here.
HWY_INLINE V raw_alpha_lanes(D d, const TileSplat& s, const PixelPlaces& at) {
  V power = hn::MulAdd(at.x, hn::Set(d, s.power[1]), hn::Set(d, s.power[0]));
  power = hn::MulAdd(at.y, hn::Set(d, s.power[2]), power);
  power = hn::MulAdd(at.xx, hn::Set(d, s.power[3]), power);
  power = hn::MulAdd(at.xy, hn::Set(d, s.power[4]), power);
  power = hn::MulAdd(at.yy, hn::Set(d, s.power[5]), power);
  return exp2_lanes(d, power);
}

/// Pixels of one row of a tile that lie in neighbouring blocks, in a register: kLanes of them from block
/// `block` on, `at` being the first one's place in its block.
HWY_INLINE V load_row(const TilePlane& plane, int block, int at) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Load(D(), plane.at[block] + at);
#else
  const hn::CappedTag<float, kBlockPx> quarter;
  const float* from = plane.at[block] + at;
#if HWY_TARGET <= HWY_AVX3
  const hn::Half<D> half;
  return hn::Combine(D(),
                     hn::Combine(half, hn::Load(quarter, from + 3 * kBlockPixels),
                                 hn::Load(quarter, from + 2 * kBlockPixels)),
                     hn::Combine(half, hn::Load(quarter, from + kBlockPixels), hn::Load(quarter, from)));
#elif HWY_TARGET <= HWY_AVX2
  return hn::Combine(D(), hn::Load(quarter, from + kBlockPixels), hn::Load(quarter, from));
#else
  return hn::Load(quarter, from);
#endif
#endif
}

/// The reverse.
HWY_INLINE void store_row(V values, TilePlane& plane, int block, int at) {
#if HWY_TARGET == HWY_SCALAR
  hn::Store(values, D(), plane.at[block] + at);
#else
  const hn::CappedTag<float, kBlockPx> quarter;
  float* to = plane.at[block] + at;
#if HWY_TARGET <= HWY_AVX3
  const hn::Half<D> half;
  const auto low = hn::LowerHalf(half, values), high = hn::UpperHalf(half, values);
  hn::Store(hn::LowerHalf(quarter, low), quarter, to);
  hn::Store(hn::UpperHalf(quarter, low), quarter, to + kBlockPixels);
  hn::Store(hn::LowerHalf(quarter, high), quarter, to + 2 * kBlockPixels);
  hn::Store(hn::UpperHalf(quarter, high), quarter, to + 3 * kBlockPixels);
#elif HWY_TARGET <= HWY_AVX2
  hn::Store(hn::LowerHalf(quarter, values), quarter, to);
  hn::Store(hn::UpperHalf(quarter, values), quarter, to + kBlockPixels);
#else
  hn::Store(values, quarter, to);
#endif
#endif
}

}  // namespace edgesplat::splat::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
