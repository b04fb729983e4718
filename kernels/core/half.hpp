// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/host_device.hpp"

#include <bit>
#include <cstdint>

#ifdef __CUDACC__
#include <cuda_fp16.h>
#endif

namespace edgesplat::core {

/// Numbers of 16 bits (IEEE 754 binary16) as their bits: 11 bits of precision, 6e-8 to 65504.

/// Nearest, ties to even. Finite numbers too large become the largest; infinities and NaN stay what they are.
inline std::uint16_t half_of_float(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto sign = static_cast<std::uint16_t>(bits >> 16U & 0x8000U);
  const std::uint32_t magnitude = bits & 0x7FFFFFFFU;
  const auto with_sign = [sign](std::uint32_t half) { return static_cast<std::uint16_t>(sign | half); };
  if (magnitude >= 0x7F800000U) return with_sign(magnitude == 0x7F800000U ? 0x7C00U : 0x7E00U);
  if (magnitude >= 0x477FF000U) return with_sign(0x7BFFU);  // would round to 65520 or more
  if (magnitude < 0x38800000U) {                            // below 2^-14: a multiple of 2^-24
    // Adding 0.5 leaves the number's multiples of 2^-24 in the lowest bits, rounded by the addition.
    const float shifted = std::bit_cast<float>(magnitude) + 0.5F;
    return with_sign(std::bit_cast<std::uint32_t>(shifted) - std::bit_cast<std::uint32_t>(0.5F));
  }
  const std::uint32_t odd = magnitude >> 13U & 1U;
  return with_sign((magnitude - 0x38000000U + 0xFFFU + odd) >> 13U);
}

EDGESPLAT_HOST_DEVICE inline float float_of_half(std::uint16_t bits) {
#ifdef __CUDA_ARCH__
  return __half2float(__ushort_as_half(bits));
#else
  const std::uint32_t sign = (bits & 0x8000U) << 16U;
  const std::uint32_t exponent = bits >> 10U & 0x1FU;
  const std::uint32_t fraction = bits & 0x3FFU;
  if (exponent == 0) {
    const float value = static_cast<float>(fraction) * 0x1p-24F;
    return sign != 0 ? -value : value;
  }
  const std::uint32_t shifted = exponent == 31 ? 255U : exponent + 112U;
  return std::bit_cast<float>(sign | shifted << 23U | fraction << 13U);
#endif
}

}  // namespace edgesplat::core
