// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/gray_rows.hpp"

#include "kernels/core/simd.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/image/gray_rows.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace edgesplat::image::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR  // one lane has no halves: the plain loops below do it all

std::size_t half_gray_vectors(const std::uint8_t*, const std::uint8_t*, std::uint8_t*, std::size_t) {
  return 0;
}
std::size_t half_vectors(const std::uint8_t*, const std::uint8_t*, std::uint8_t*, std::size_t) {
  return 0;
}
std::size_t gray_vectors(const std::uint8_t*, std::uint8_t*, std::size_t) {
  return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Bytes = hn::ScalableTag<std::uint8_t>;
using Words = hn::Repartition<std::uint16_t, Bytes>;
using Ints = hn::Repartition<std::int32_t, Bytes>;
using HalfWords = hn::Half<Words>;
using HalfBytes = hn::Rebind<std::uint8_t, Words>;    // as many as there are words
using QuarterBytes = hn::Rebind<std::uint8_t, Ints>;  // as many as there are ints

/// ITU-R BT.601 in 256ths.
constexpr int kRed = 77, kGreen = 150, kBlue = 29;

HWY_INLINE hn::Vec<Words> neighbours(hn::Vec<Bytes> v) {
  const auto pairs = hn::BitCast(Words(), v);
  return hn::Add(hn::And(pairs, hn::Set(Words(), 0xFF)), hn::ShiftRight<8>(pairs));
}

HWY_INLINE hn::Vec<QuarterBytes> weigh(hn::Vec<HalfWords> red, hn::Vec<HalfWords> green,
                                       hn::Vec<HalfWords> blue) {
  const Ints d;
  auto sum = hn::Mul(hn::PromoteTo(d, red), hn::Set(d, kRed));
  sum = hn::Add(sum, hn::Mul(hn::PromoteTo(d, green), hn::Set(d, kGreen)));
  sum = hn::Add(sum, hn::Mul(hn::PromoteTo(d, blue), hn::Set(d, kBlue)));
  return hn::DemoteTo(QuarterBytes(), hn::ShiftRight<10>(hn::Add(sum, hn::Set(d, 512))));
}

std::size_t half_gray_vectors(const std::uint8_t* above, const std::uint8_t* below, std::uint8_t* gray,
                              std::size_t count) {
  const Bytes d;
  const std::size_t out = hn::Lanes(Words()), part = hn::Lanes(Ints());
  std::size_t i = 0;
  for (; i + out <= count; i += out, above += 6 * out, below += 6 * out) {
    hn::Vec<Bytes> r0, g0, b0, r1, g1, b1;
    hn::LoadInterleaved3(d, above, r0, g0, b0);
    hn::LoadInterleaved3(d, below, r1, g1, b1);
    const auto r = hn::Add(neighbours(r0), neighbours(r1));
    const auto g = hn::Add(neighbours(g0), neighbours(g1));
    const auto b = hn::Add(neighbours(b0), neighbours(b1));
    const HalfWords h;
    hn::StoreU(weigh(hn::LowerHalf(h, r), hn::LowerHalf(h, g), hn::LowerHalf(h, b)), QuarterBytes(),
               gray + i);
    hn::StoreU(weigh(hn::UpperHalf(h, r), hn::UpperHalf(h, g), hn::UpperHalf(h, b)), QuarterBytes(),
               gray + i + part);
  }
  return i;
}

std::size_t half_vectors(const std::uint8_t* above, const std::uint8_t* below, std::uint8_t* half,
                         std::size_t count) {
  const Bytes d;
  const Words words;
  const hn::RebindToSigned<Words> shorts;
  const std::size_t out = hn::Lanes(words);
  std::size_t i = 0;
  for (; i + out <= count; i += out, above += 2 * out, below += 2 * out) {
    const auto sum = hn::Add(neighbours(hn::LoadU(d, above)), neighbours(hn::LoadU(d, below)));
    const auto mean = hn::ShiftRight<2>(hn::Add(sum, hn::Set(words, 2)));
    hn::StoreU(hn::DemoteTo(HalfBytes(), hn::BitCast(shorts, mean)), HalfBytes(), half + i);
  }
  return i;
}

std::size_t gray_vectors(const std::uint8_t* rgb, std::uint8_t* gray, std::size_t count) {
  const Bytes d;
  const Words words;
  const hn::RebindToSigned<Words> shorts;
  const HalfBytes half;
  const std::size_t out = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + out <= count; i += out, rgb += 3 * out) {
    hn::Vec<Bytes> r, g, b;
    hn::LoadInterleaved3(d, rgb, r, g, b);
    // At most 255 * 256 + 128: it fits 16 bits.
    const auto mix = [&](auto red, auto green, auto blue) {
      auto sum = hn::Mul(hn::PromoteTo(words, red), hn::Set(words, kRed));
      sum = hn::Add(sum, hn::Mul(hn::PromoteTo(words, green), hn::Set(words, kGreen)));
      sum = hn::Add(sum, hn::Mul(hn::PromoteTo(words, blue), hn::Set(words, kBlue)));
      const auto value = hn::ShiftRight<8>(hn::Add(sum, hn::Set(words, 128)));
      return hn::DemoteTo(half, hn::BitCast(shorts, value));
    };
    hn::StoreU(mix(hn::LowerHalf(half, r), hn::LowerHalf(half, g), hn::LowerHalf(half, b)), half, gray + i);
    hn::StoreU(mix(hn::UpperHalf(half, r), hn::UpperHalf(half, g), hn::UpperHalf(half, b)), half,
               gray + i + out / 2);
  }
  return i;
}

#endif

}  // namespace
}  // namespace edgesplat::image::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgesplat::image {

HWY_EXPORT(half_gray_vectors);
HWY_EXPORT(half_vectors);
HWY_EXPORT(gray_vectors);

void half_gray_row(const std::uint8_t* above, const std::uint8_t* below, std::uint8_t* gray,
                   std::size_t count) {
  std::size_t i = HWY_DYNAMIC_DISPATCH(half_gray_vectors)(above, below, gray, count);
  for (; i < count; ++i) {
    const std::uint8_t *a = above + 6 * i, *b = below + 6 * i;
    const int red = a[0] + a[3] + b[0] + b[3];
    const int green = a[1] + a[4] + b[1] + b[4];
    const int blue = a[2] + a[5] + b[2] + b[5];
    gray[i] = static_cast<std::uint8_t>((77 * red + 150 * green + 29 * blue + 512) >> 10);
  }
}

void half_row(const std::uint8_t* above, const std::uint8_t* below, std::uint8_t* half, std::size_t count) {
  std::size_t i = HWY_DYNAMIC_DISPATCH(half_vectors)(above, below, half, count);
  for (; i < count; ++i) {
    const std::uint8_t *a = above + 2 * i, *b = below + 2 * i;
    half[i] = static_cast<std::uint8_t>((a[0] + a[1] + b[0] + b[1] + 2) >> 2);
  }
}

void gray_row(const std::uint8_t* rgb, std::uint8_t* gray, std::size_t count) {
  std::size_t i = HWY_DYNAMIC_DISPATCH(gray_vectors)(rgb, gray, count);
  for (; i < count; ++i) {
    const std::uint8_t* p = rgb + 3 * i;
    gray[i] = static_cast<std::uint8_t>((77 * p[0] + 150 * p[1] + 29 * p[2] + 128) >> 8);
  }
}

}  // namespace edgesplat::image
#endif
