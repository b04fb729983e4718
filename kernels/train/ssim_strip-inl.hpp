// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0

// The inner loops of SSIM; compiled once for each set of vector instructions, so the guard is a toggle (see
// Highway's documentation on -inl.h files).
#if defined(EDGESPLAT_KERNELS_TRAIN_SSIM_STRIP_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGESPLAT_KERNELS_TRAIN_SSIM_STRIP_INL_HPP
#undef EDGESPLAT_KERNELS_TRAIN_SSIM_STRIP_INL_HPP
#else
#define EDGESPLAT_KERNELS_TRAIN_SSIM_STRIP_INL_HPP
#endif

#include "kernels/core/vectors-inl.hpp"
#include "kernels/train/ssim_strip.hpp"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace edgesplat::train::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kSsimLanes>;
using V = hn::Vec<D>;

/// exp(-d^2 / (2 1.5^2)) for d = -5..5, normalised over the window.
inline constexpr float kWindow[kSsimTaps] = {
    0.001028380084F, 0.007598758135F, 0.036000772128F, 0.109360689510F, 0.213005537711F, 0.266011724862F,
    0.213005537711F, 0.109360689510F, 0.036000772128F, 0.007598758135F, 0.001028380084F};

/// Filters along a row: `to` [count] from `from` [count + 2 kSsimHalo], count a multiple of kSsimLanes.
HWY_INLINE void along_row(const float* HWY_RESTRICT from, int count, float* HWY_RESTRICT to) {
  const D d;
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const float* at = from + i;
    V sum = hn::Mul(hn::Set(d, kWindow[0]), hn::Add(hn::LoadU(d, at), hn::LoadU(d, at + 2 * kSsimHalo)));
    for (int k = 1; k < kSsimRadius; ++k) {
      sum = hn::MulAdd(hn::Set(d, kWindow[k]),
                       hn::Add(hn::LoadU(d, at + 3 * k), hn::LoadU(d, at + 2 * kSsimHalo - 3 * k)), sum);
    }
    sum = hn::MulAdd(hn::Set(d, kWindow[kSsimRadius]), hn::LoadU(d, at + kSsimHalo), sum);
    hn::Store(sum, d, to + i);
  }
}

/// Filters down the columns, one register wide: kSsimBatch rows of results from the kSsimWindow rows around
/// them, each of which is loaded once.
HWY_INLINE void across_rows(const float* const* rows, int at, V* sums) {
  const D d;
  for (int j = 0; j < kSsimBatch; ++j) sums[j] = hn::Zero(d);
  HWY_UNROLL(kSsimWindow)
  for (int r = 0; r < kSsimWindow; ++r) {
    const V v = hn::Load(d, rows[r] + at);
    HWY_UNROLL(kSsimBatch)
    for (int j = 0; j < kSsimBatch; ++j) {
      if (r - j >= 0 && r - j < kSsimTaps) sums[j] = hn::MulAdd(hn::Set(d, kWindow[r - j]), v, sums[j]);
    }
  }
}

/// The similarity and its slopes: by the mean of x, by that of x^2 + y^2 and by that of x y.
struct Similarity {
  V value, by_sum, by_squares, by_product;
};
HWY_INLINE Similarity similarity(V x, V y, V squares, V product) {
  const D d;
  const V c1 = hn::Set(d, 0.01F * 0.01F), c2 = hn::Set(d, 0.03F * 0.03F), two = hn::Set(d, 2.0F);
  const V xy = hn::Mul(x, y), both = hn::MulAdd(x, x, hn::Mul(y, y));
  const V n1 = hn::MulAdd(two, xy, c1);
  const V n2 = hn::MulAdd(two, hn::Sub(product, xy), c2);
  const V d1 = hn::Add(both, c1);
  const V d2 = hn::Add(hn::Sub(squares, both), c2);
  const V inverse = core::HWY_NAMESPACE::reciprocal(d, hn::Mul(d1, d2));
  const V n1_inverse = hn::Mul(n1, inverse);
  const V value = hn::Mul(n1_inverse, n2);
  const V by_product = hn::Add(n1_inverse, n1_inverse);
  const V by_squares = hn::Neg(hn::Mul(hn::Mul(value, d1), inverse));
  const V slope = hn::Sub(hn::Mul(y, hn::Sub(n2, n1)), hn::Mul(hn::Mul(x, value), hn::Sub(d2, d1)));
  // As a whole: g++ makes a constructor without arguments outside of the vectors' target, which on aarch64 is
  // an error.
  return {value, hn::Mul(hn::Mul(two, slope), inverse), by_squares, by_product};
}

}  // namespace edgesplat::train::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
