// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0

// Compiled once for each set of vector instructions, so the guard is a toggle (see Highway's documentation on
// -inl.h files).
#if defined(EDGESPLAT_KERNELS_CORE_VECTORS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef EDGESPLAT_KERNELS_CORE_VECTORS_INL_HPP
#undef EDGESPLAT_KERNELS_CORE_VECTORS_INL_HPP
#else
#define EDGESPLAT_KERNELS_CORE_VECTORS_INL_HPP
#endif

#include <hwy/highway.h>

#include <cstddef>

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

/// The first `count` lanes from memory, zero in the others; nothing beyond them is read. From any address,
/// unlike Highway's masked loads.
template <typename D>
HWY_INLINE hn::Vec<D> load_some(D d, const float* from, std::size_t count) {
  if (count == hn::Lanes(d)) return hn::LoadU(d, from);
  alignas(64) float values[hn::MaxLanes(d)] = {};
  for (std::size_t i = 0; i < count; ++i) values[i] = from[i];
  return hn::Load(d, values);
}

/// The first `count` lanes to memory, at any address.
template <typename D>
HWY_INLINE void store_some(D d, hn::Vec<D> values, float* to, std::size_t count) {
  if (count == hn::Lanes(d)) return hn::StoreU(values, d, to);
  alignas(64) float copies[hn::MaxLanes(d)];
  hn::Store(values, d, copies);
  for (std::size_t i = 0; i < count; ++i) to[i] = copies[i];
}

}  // namespace edgesplat::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
