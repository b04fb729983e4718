// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/simd_variants.hpp"
#include "kernels/train/colour_pair.hpp"

#include <cstddef>

namespace edgesplat::train::ssim_strip {

/// The inner loops of SSIM on a piece of the picture that fits the cache: rows of floats (3 a pixel) stream
/// through two separable filters, one for the local moments and one for the gradient. Every loop is over
/// neighbouring floats, so it vectorises; a tap k of the window is 3 k floats away.

inline constexpr int kRadius = 5;
inline constexpr int kTaps = 2 * kRadius + 1;
inline constexpr int kStripPx = 128;   ///< width of a piece
inline constexpr int kStripRows = 64;  ///< height of a piece
inline constexpr int kHalo = 3 * kRadius;
inline constexpr int kOut = 3 * kStripPx;         ///< floats a row of the result
inline constexpr int kMiddle = kOut + 2 * kHalo;  ///< of the similarity, which the gradient looks around in
inline constexpr int kIn = kMiddle + 2 * kHalo;   ///< of the pictures

/// exp(-d^2 / (2 1.5^2)) for d = 0..5, normalised over the window.
inline constexpr float kWindow[kRadius + 1] = {0.266011724862F, 0.213005537711F, 0.109360689510F,
                                               0.036000772128F, 0.007598758135F, 0.001028380084F};

/// Filters along a row: `to` [count] from `from` [count + 2 kHalo].
EDGESPLAT_INLINE void along_row(const float* __restrict from, int count, float* __restrict to) {
  for (int i = 0; i < count; ++i) {
    const float* at = from + i + kHalo;
    float sum = kWindow[0] * at[0];
    for (int k = 1; k <= kRadius; ++k) sum += kWindow[k] * (at[-3 * k] + at[3 * k]);
    to[i] = sum;
  }
}

/// Filters down the columns: `rows` are the kTaps rows around the result, oldest first.
EDGESPLAT_INLINE void across_rows(const float* const* rows, int count, float* __restrict to) {
  for (int i = 0; i < count; ++i) {
    float sum = kWindow[0] * rows[kRadius][i];
    for (int k = 1; k <= kRadius; ++k) sum += kWindow[k] * (rows[kRadius - k][i] + rows[kRadius + k][i]);
    to[i] = sum;
  }
}

/// The last kTaps rows of N quantities.
template <std::size_t N, std::size_t Floats>
struct Ring {
  float rows[kTaps][N][Floats];

  /// Row `number` counts from 0 and may run on.
  EDGESPLAT_INLINE float* row(int number, int quantity) {
    return rows[static_cast<std::size_t>(number % kTaps)][static_cast<std::size_t>(quantity)];
  }
  /// The rows up to `newest`, oldest first.
  EDGESPLAT_INLINE void window(int newest, int quantity, const float** out) {
    for (int k = 0; k < kTaps; ++k) out[k] = row(newest - kTaps + 1 + k, quantity);
  }
};

/// Local moments of a row: means of x and y, of x^2 + y^2 and of x y.
enum Moment { kMeanX, kMeanY, kSquares, kProduct, kMoments };
/// dS by the mean of x, by that of x^2 + y^2 and by that of x y.
enum Slope { kBySum, kBySquares, kByProduct, kSlopes };

/// Similarity of `count` floats; adds weight times it to `sum` and leaves weight times its slopes.
EDGESPLAT_INLINE void similarity(const float* const* m, const float* __restrict weight, int count,
                                 float* __restrict sum, float* const* slopes) {
  constexpr float kC1 = 0.01F * 0.01F;
  constexpr float kC2 = 0.03F * 0.03F;
  float* __restrict by_sum = slopes[kBySum];
  float* __restrict by_squares = slopes[kBySquares];
  float* __restrict by_product = slopes[kByProduct];
  for (int i = 0; i < count; ++i) {
    const float x = m[kMeanX][i], y = m[kMeanY][i];
    const float n1 = 2.0F * x * y + kC1;
    const float n2 = 2.0F * (m[kProduct][i] - x * y) + kC2;
    const float d1 = x * x + y * y + kC1;
    const float d2 = m[kSquares][i] - x * x - y * y + kC2;
    const float inverse = 1.0F / (d1 * d2);
    const float s = n1 * n2 * inverse;
    const float w = weight[i];
    sum[i] += w * s;
    by_sum[i] = w * 2.0F * (y * (n2 - n1) - x * s * (d2 - d1)) * inverse;
    by_squares[i] = -w * s * d1 * inverse;
    by_product[i] = w * 2.0F * n1 * inverse;
  }
}

}  // namespace edgesplat::train::ssim_strip
