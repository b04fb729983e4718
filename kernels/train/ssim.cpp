// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/ssim.hpp"

#include "common/base/check.hpp"
#include "common/thread/parallel_for.hpp"
#include "kernels/train/ssim_strip.hpp"

#include <algorithm>
#include <memory>
#include <vector>

namespace edgesplat::train {
namespace {

using namespace ssim_strip;  // NOLINT(google-build-using-namespace): this file is its other half

/// One piece of the picture: kStripPx by kStripRows, less at the edges.
struct Strip {
  const ColourPair& pair;
  int x0_px, y0_px;
  int rows;
  float scale;                ///< of the gradient
  std::span<float> by_drawn;  ///< empty: only the value
};

struct Buffers {
  float x[kIn], y[kIn], squares[kIn], product[kIn];
  Ring<kMoments, std::size_t{kMiddle}> moments;
  float moment_rows[kMoments][kMiddle];
  float weight[kMiddle];
  float slope_rows[kSlopes][kMiddle];
  Ring<kSlopes, std::size_t{kOut}> slopes;
  float out[kSlopes][kOut];
  float sum[kMiddle];       ///< of the similarity, column by column
  float not_ours[kMiddle];  ///< the same of rows that another piece adds up
};

/// The part of a row of `floats` starting at float `first` of the picture that lies in it.
struct Overlap {
  int from, to;  ///< in the row: [from, to)
};
EDGESPLAT_INLINE Overlap overlap(int first, int floats, int width_px) {
  return {std::max(0, -first), std::min(floats, 3 * width_px - first)};
}

EDGESPLAT_INLINE float weight_at(const ColourPair& pair, int y, int column) {
  return pair.weight.empty() ? 1.0F : pair.weight[static_cast<std::size_t>(y * pair.width_px + column / 3)];
}

/// Row y of both pictures into b.x and b.y, zero beyond the edges.
EDGESPLAT_INLINE void load_pictures(const Strip& s, int y, Buffers& b) {
  std::fill_n(b.x, kIn, 0.0F);
  std::fill_n(b.y, kIn, 0.0F);
  if (y >= 0 && y < s.pair.height_px) {
    const int first = 3 * s.x0_px - 2 * kHalo;
    const Overlap inside = overlap(first, kIn, s.pair.width_px);
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(3 * s.pair.width_px);
    for (int i = inside.from; i < inside.to; ++i) {
      const std::size_t at = row + static_cast<std::size_t>(first + i);
      b.x[i] = s.pair.drawn[at];
      b.y[i] = s.pair.target[at];
    }
    if (!s.pair.weight.empty()) {
      for (int i = inside.from; i < inside.to; ++i) {
        const float w = weight_at(s.pair, y, first + i);
        b.x[i] *= w;
        b.y[i] *= w;
      }
    }
  }
  for (int i = 0; i < kIn; ++i) {
    b.squares[i] = b.x[i] * b.x[i] + b.y[i] * b.y[i];
    b.product[i] = b.x[i] * b.y[i];
  }
}

EDGESPLAT_INLINE void load_weight(const Strip& s, int y, Buffers& b) {
  std::fill_n(b.weight, kMiddle, 0.0F);
  if (y < 0 || y >= s.pair.height_px) return;
  const int first = 3 * s.x0_px - kHalo;
  const Overlap inside = overlap(first, kMiddle, s.pair.width_px);
  for (int i = inside.from; i < inside.to; ++i) b.weight[i] = weight_at(s.pair, y, first + i);
}

/// The similarity of row y from the newest rows of moments, and its slopes filtered along the row.
EDGESPLAT_INLINE void middle_row(const Strip& s, int newest, int y, Buffers& b) {
  const float* rows[kTaps];
  const float* moments[kMoments];
  float* slopes[kSlopes];
  for (int q = 0; q < kMoments; ++q) {
    b.moments.window(newest, q, rows);
    across_rows(rows, kMiddle, b.moment_rows[q]);
    moments[q] = b.moment_rows[q];
  }
  for (int q = 0; q < kSlopes; ++q) slopes[q] = b.slope_rows[q];
  load_weight(s, y, b);
  const bool ours = y >= s.y0_px && y < s.y0_px + s.rows;
  similarity(moments, b.weight, kMiddle, ours ? b.sum : b.not_ours, slopes);
  if (s.by_drawn.empty()) return;
  const int number = newest - 2 * kRadius;
  for (int q = 0; q < kSlopes; ++q) along_row(b.slope_rows[q], kOut, b.slopes.row(number, q));
}

/// Adds the gradient of row y from the newest rows of slopes.
EDGESPLAT_INLINE void gradient_row(const Strip& s, int newest, int y, Buffers& b) {
  const float* rows[kTaps];
  for (int q = 0; q < kSlopes; ++q) {
    b.slopes.window(newest, q, rows);
    across_rows(rows, kOut, b.out[q]);
  }
  const int floats = std::min(kOut, 3 * (s.pair.width_px - s.x0_px));
  const std::size_t at = (static_cast<std::size_t>(y) * static_cast<std::size_t>(s.pair.width_px) +
                          static_cast<std::size_t>(s.x0_px)) *
                         3;
  const float* __restrict drawn = s.pair.drawn.data() + at;
  const float* __restrict target = s.pair.target.data() + at;
  float* __restrict by = s.by_drawn.data() + at;
  if (s.pair.weight.empty()) {
    for (int i = 0; i < floats; ++i) {
      by[i] += s.scale *
               (b.out[kBySum][i] + 2.0F * drawn[i] * b.out[kBySquares][i] + target[i] * b.out[kByProduct][i]);
    }
    return;
  }
  for (int i = 0; i < floats; ++i) {
    const float w = weight_at(s.pair, y, 3 * s.x0_px + i);
    by[i] +=
        s.scale * w *
        (b.out[kBySum][i] + w * (2.0F * drawn[i] * b.out[kBySquares][i] + target[i] * b.out[kByProduct][i]));
  }
}

EDGESPLAT_INLINE void run_strip_inline(const Strip& s, Buffers& b) {
  const int last = s.rows + (s.by_drawn.empty() ? 3 : 4) * kRadius;
  for (int n = s.by_drawn.empty() ? kRadius : 0; n < last; ++n) {
    load_pictures(s, s.y0_px - 2 * kRadius + n, b);
    const float* in[kMoments] = {b.x, b.y, b.squares, b.product};
    for (int q = 0; q < kMoments; ++q) along_row(in[q], kMiddle, b.moments.row(n, q));
    const int middle = n - 2 * kRadius;
    const int first_middle = s.by_drawn.empty() ? kRadius : 0;
    if (middle < first_middle) continue;
    middle_row(s, n, s.y0_px - kRadius + middle, b);
    const int out = middle - 2 * kRadius;
    if (out >= 0 && !s.by_drawn.empty()) gradient_row(s, middle, s.y0_px + out, b);
  }
}

EDGESPLAT_SIMD_VARIANTS(run_strip, (const Strip& s, Buffers& b), (s, b))

/// Sum of weight times similarity over all pixels and channels.
double run(const ColourPair& pair, float scale, std::span<float> by_drawn) {
  const int columns = (pair.width_px + kStripPx - 1) / kStripPx;
  const int rows = (pair.height_px + kStripRows - 1) / kStripRows;
  std::vector<double> sums(static_cast<std::size_t>(columns * rows), 0.0);
  const auto run_strip = fastest_run_strip();
  thread::parallel_for(0, columns * rows, [&](int i) {
    const int y0 = i / columns * kStripRows;
    const Strip strip{pair,    i % columns * kStripPx, y0, std::min(kStripRows, pair.height_px - y0), scale,
                      by_drawn};
    const auto buffers = std::make_unique<Buffers>();
    run_strip(strip, *buffers);
    double sum = 0.0;
    for (int k = kHalo; k < kHalo + kOut; ++k) sum += static_cast<double>(buffers->sum[k]);
    sums[static_cast<std::size_t>(i)] = sum;
  });
  double sum = 0.0;
  for (const double part : sums) sum += part;
  return sum;
}

}  // namespace

double ssim(const ColourPair& pair) {
  EDGESPLAT_CHECK(pair.consistent(), "two pictures of one size");
  const double total = 3.0 * pair.total_weight();
  return total > 0.0 ? run(pair, 0.0F, {}) / total : 0.0;
}

double ssim_backward(const ColourPair& pair, float factor, std::span<float> by_drawn) {
  EDGESPLAT_CHECK(pair.consistent() && by_drawn.size() == pair.drawn.size(), "three pictures of one size");
  const double total = 3.0 * pair.total_weight();
  if (!(total > 0.0)) return 0.0;
  return run(pair, static_cast<float>(static_cast<double>(factor) / total), by_drawn) / total;
}

}  // namespace edgesplat::train
