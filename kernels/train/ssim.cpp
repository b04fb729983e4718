// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/ssim.hpp"

#include "common/base/check.hpp"
#include "common/thread/parallel_for.hpp"
#include "kernels/core/simd.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/train/ssim.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "kernels/train/ssim_strip-inl.hpp"

#include <hwy/highway.h>

#ifndef EDGESPLAT_KERNELS_TRAIN_SSIM_ONCE
#define EDGESPLAT_KERNELS_TRAIN_SSIM_ONCE
namespace edgesplat::train {

/// One piece of the picture: kSsimStripPx by kSsimStripRows, less at the edges.
struct SsimStrip {
  const ColourPair& pair;
  int x0_px, y0_px;
  int rows;
  float scale;                ///< of the gradient of the similarity
  float l1_scale;             ///< of that of the absolute difference
  std::span<float> by_drawn;  ///< empty: only the value of the similarity
};

/// Local moments: means of x and y, of x^2 + y^2 and of x y.
enum SsimMoment { kMeanX, kMeanY, kSquares, kProduct, kMoments };
/// Slopes by the mean of x, by that of x^2 + y^2 and by that of x y.
enum SsimSlope { kBySum, kBySquares, kByProduct, kSlopes };

struct SsimBuffers {
  alignas(64) float in[kMoments][whole_lanes(kSsimIn)];
  alignas(64) float moments[kMoments][kSsimRing][kSsimMiddle];
  alignas(64) float weight[kSsimBatch][kSsimMiddle];
  alignas(64) float slope_rows[kSsimBatch][kSlopes][whole_lanes(kSsimMiddle + 2 * kSsimHalo)];
  alignas(64) float slopes[kSlopes][kSsimRing][kSsimOut];
  alignas(64) float sum[kSsimMiddle];  ///< of the similarity, column by column
  alignas(64) float l1_sum[kSsimOut];  ///< of the absolute differences
};

/// The part of a row of `floats` starting at float `first` of the picture that lies in it.
struct SsimOverlap {
  int from, to;  ///< in the row: [from, to)
};
inline SsimOverlap overlap(int first, int floats, int width_px) {
  return {std::max(0, -first), std::min(floats, 3 * width_px - first)};
}

inline float weight_at(const ColourPair& pair, int y, int column) {
  return pair.weight.empty() ? 1.0F : pair.weight[static_cast<std::size_t>(y * pair.width_px + column / 3)];
}

struct SsimRow {
  const float* drawn;
  const float* target;
};

/// Row y of both pictures, times the weights, zero beyond the edges: kSsimIn floats and up to a register
/// more. In place where it lies inside and everything counts.
inline SsimRow load_pictures(const SsimStrip& s, int y, SsimBuffers& b) {
  float* x = b.in[kMeanX];
  float* t = b.in[kMeanY];
  const int first = 3 * s.x0_px - 2 * kSsimHalo;
  const SsimOverlap inside = overlap(first, whole_lanes(kSsimIn), s.pair.width_px);
  const SsimRow copies{x, t};
  if (y < 0 || y >= s.pair.height_px) {
    std::fill_n(x, whole_lanes(kSsimIn), 0.0F);
    std::fill_n(t, whole_lanes(kSsimIn), 0.0F);
    return copies;
  }
  const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(3 * s.pair.width_px) +
                         static_cast<std::size_t>(first + inside.from);
  const auto count = static_cast<std::size_t>(inside.to - inside.from);
  if (inside.from == 0 && inside.to == whole_lanes(kSsimIn) && s.pair.weight.empty())
    return {&s.pair.drawn[at], &s.pair.target[at]};
  for (float* row : {x, t}) {
    std::fill_n(row, inside.from, 0.0F);
    std::fill(row + inside.to, row + whole_lanes(kSsimIn), 0.0F);
  }
  std::copy_n(&s.pair.drawn[at], count, x + inside.from);
  std::copy_n(&s.pair.target[at], count, t + inside.from);
  if (s.pair.weight.empty()) return copies;
  for (int i = inside.from; i < inside.to; ++i) {
    const float w = weight_at(s.pair, y, first + i);
    x[i] *= w;
    t[i] *= w;
  }
  return copies;
}

inline void load_weight(const SsimStrip& s, int y, float* weight) {
  std::fill_n(weight, kSsimMiddle, 0.0F);
  if (y < 0 || y >= s.pair.height_px) return;
  const int first = 3 * s.x0_px - kSsimHalo;
  const SsimOverlap inside = overlap(first, kSsimOut + 2 * kSsimHalo, s.pair.width_px);
  for (int i = inside.from; i < inside.to; ++i) weight[i] = weight_at(s.pair, y, first + i);
}

}  // namespace edgesplat::train
#endif

HWY_BEFORE_NAMESPACE();
namespace edgesplat::train::HWY_NAMESPACE {

constexpr int kStep = static_cast<int>(hn::MaxLanes(D()));

/// Rows `first` and following of the moments, of the picture's rows from y on.
void moment_rows(const SsimStrip& s, int first, int y, SsimBuffers& b) {
  const D d;
  for (int j = 0; j < kSsimBatch; ++j) {
    const SsimRow row = load_pictures(s, y + j, b);
    for (int i = 0; i < whole_lanes(kSsimIn); i += kStep) {
      const V x = hn::LoadU(d, row.drawn + i), t = hn::LoadU(d, row.target + i);
      hn::Store(hn::MulAdd(x, x, hn::Mul(t, t)), d, b.in[kSquares] + i);
      hn::Store(hn::Mul(x, t), d, b.in[kProduct] + i);
    }
    const float* in[kMoments] = {row.drawn, row.target, b.in[kSquares], b.in[kProduct]};
    for (int q = 0; q < kMoments; ++q) along_row(in[q], kSsimMiddle, b.moments[q][(first + j) % kSsimRing]);
  }
}

/// The similarity of the rows from y on, from the rows of moments from `window` on, and its slopes filtered
/// along the row, which become rows `first` and following.
void middle_rows(const SsimStrip& s, int window, int first, int y, SsimBuffers& b) {
  const D d;
  const float* rows[kMoments][kSsimWindow];
  for (int q = 0; q < kMoments; ++q) {
    for (int r = 0; r < kSsimWindow; ++r) rows[q][r] = b.moments[q][(window + r) % kSsimRing];
  }
  V ours[kSsimBatch];
  for (int j = 0; j < kSsimBatch; ++j) {
    load_weight(s, y + j, b.weight[j]);
    // What other pieces add up as well counts there.
    ours[j] = hn::Set(d, y + j >= s.y0_px && y + j < s.y0_px + s.rows ? 1.0F : 0.0F);
  }
  for (int i = 0; i < kSsimMiddle; i += kStep) {
    V moments[kMoments][kSsimBatch];
    for (int q = 0; q < kMoments; ++q) across_rows(rows[q], i, moments[q]);
    V sum = hn::Load(d, b.sum + i);
    for (int j = 0; j < kSsimBatch; ++j) {
      const Similarity at =
          similarity(moments[kMeanX][j], moments[kMeanY][j], moments[kSquares][j], moments[kProduct][j]);
      const V weight = hn::Load(d, b.weight[j] + i);
      sum = hn::MulAdd(hn::Mul(weight, ours[j]), at.value, sum);
      hn::Store(hn::Mul(weight, at.by_sum), d, b.slope_rows[j][kBySum] + i);
      hn::Store(hn::Mul(weight, at.by_squares), d, b.slope_rows[j][kBySquares] + i);
      hn::Store(hn::Mul(weight, at.by_product), d, b.slope_rows[j][kByProduct] + i);
    }
    hn::Store(sum, d, b.sum + i);
  }
  if (s.by_drawn.empty()) return;
  for (int j = 0; j < kSsimBatch; ++j) {
    for (int q = 0; q < kSlopes; ++q)
      along_row(b.slope_rows[j][q], kSsimOut, b.slopes[q][(first + j) % kSsimRing]);
  }
}

/// The gradient of the rows from y on, from the rows of slopes from `window` on.
void gradient_rows(const SsimStrip& s, int window, int y, SsimBuffers& b) {
  const D d;
  const float* rows[kSlopes][kSsimWindow];
  for (int q = 0; q < kSlopes; ++q) {
    for (int r = 0; r < kSsimWindow; ++r) rows[q][r] = b.slopes[q][(window + r) % kSsimRing];
  }
  const int count = std::min(kSsimBatch, s.y0_px + s.rows - y);
  const int floats = std::min(kSsimOut, 3 * (s.pair.width_px - s.x0_px));
  const V scale = hn::Set(d, s.scale), l1_scale = hn::Set(d, s.l1_scale), two = hn::Set(d, 2.0F);
  for (int i = 0; i < floats; i += kStep) {
    V slopes[kSlopes][kSsimBatch];
    for (int q = 0; q < kSlopes; ++q) across_rows(rows[q], i, slopes[q]);
    const auto some = static_cast<std::size_t>(std::min(kStep, floats - i));
    V l1_sum = hn::Load(d, b.l1_sum + i);
    for (int j = 0; j < count; ++j) {
      const std::size_t at = (static_cast<std::size_t>(y + j) * static_cast<std::size_t>(s.pair.width_px) +
                              static_cast<std::size_t>(s.x0_px)) *
                                 3 +
                             static_cast<std::size_t>(i);
      const auto load = [&](const float* from)
                            HWY_ATTR { return core::HWY_NAMESPACE::load_some(d, from, some); };
      V weight = hn::Set(d, 1.0F);
      if (!s.pair.weight.empty()) {
        alignas(64) float weights[kSsimLanes] = {};
        for (int k = 0; k < static_cast<int>(some); ++k)
          weights[k] = weight_at(s.pair, y + j, 3 * s.x0_px + i + k);
        weight = hn::Load(d, weights);
      }
      const V drawn = load(&s.pair.drawn[at]), target = load(&s.pair.target[at]);
      const V of_products =
          hn::MulAdd(hn::Mul(two, drawn), slopes[kBySquares][j], hn::Mul(target, slopes[kByProduct][j]));
      const V by = hn::Mul(hn::Mul(scale, weight), hn::MulAdd(weight, of_products, slopes[kBySum][j]));
      const V apart = hn::Mul(weight, hn::Sub(drawn, target));
      l1_sum = hn::Add(l1_sum, hn::Abs(apart));
      const V towards = hn::IfThenElseZero(hn::Ne(apart, hn::Zero(d)), hn::CopySign(l1_scale, apart));
      core::HWY_NAMESPACE::store_some(d, hn::MulAdd(towards, weight, by), &s.by_drawn[at], some);
    }
    hn::Store(l1_sum, d, b.l1_sum + i);
  }
}

/// Everything of one piece; its similarities end up in b.sum. Row 0 of the moments lies so far above the
/// piece that a batch of them completes a batch of the similarity kLag back, and that one a batch of the
/// gradient kLag back again.
void run_strip(const SsimStrip& s, SsimBuffers& b) {
  constexpr int kLag = kSsimLead / kSsimBatch;
  constexpr int kRise = kSsimRadius + kSsimSkip;  // of row 0 of one stage above row 0 of the next
  const bool with_gradient = !s.by_drawn.empty();
  const int middle_y = with_gradient ? s.y0_px - kRise : s.y0_px;
  const int batches = (s.rows + kSsimBatch - 1) / kSsimBatch + (with_gradient ? 2 * kLag : kLag);
  std::fill_n(b.sum, kSsimMiddle, 0.0F);
  std::fill_n(b.l1_sum, kSsimOut, 0.0F);
  for (int n = 0; n < batches; ++n) {
    moment_rows(s, n * kSsimBatch, middle_y - kRise + n * kSsimBatch, b);
    const int middle = (n - kLag) * kSsimBatch;
    if (middle < 0) continue;
    middle_rows(s, middle + kSsimSkip, middle, middle_y + middle, b);
    const int out = middle - kLag * kSsimBatch;
    if (with_gradient && out >= 0) gradient_rows(s, out + kSsimSkip, s.y0_px + out, b);
  }
}

}  // namespace edgesplat::train::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgesplat::train {
namespace {

HWY_EXPORT(run_strip);

/// Sums over all pixels and channels, times their weights.
struct Sums {
  double similarity = 0.0, apart = 0.0;
};

Sums run(const ColourPair& pair, float scale, float l1_scale, std::span<float> by_drawn) {
  const int columns = (pair.width_px + kSsimStripPx - 1) / kSsimStripPx;
  const int rows = (pair.height_px + kSsimStripRows - 1) / kSsimStripRows;
  std::vector<Sums> parts(static_cast<std::size_t>(columns * rows));
  thread::parallel_for(0, columns * rows, [&](int i) {
    const int y0 = i / columns * kSsimStripRows;
    const SsimStrip strip{pair,    i % columns * kSsimStripPx,
                          y0,      std::min(kSsimStripRows, pair.height_px - y0),
                          scale,   l1_scale,
                          by_drawn};
    thread_local auto buffers = std::make_unique<SsimBuffers>();
    HWY_DYNAMIC_DISPATCH(run_strip)(strip, *buffers);
    Sums& part = parts[static_cast<std::size_t>(i)];
    for (int k = 0; k < kSsimOut; ++k) {
      part.similarity += static_cast<double>(buffers->sum[kSsimHalo + k]);
      part.apart += static_cast<double>(buffers->l1_sum[k]);
    }
  });
  Sums sums;
  for (const Sums& part : parts) {
    sums.similarity += part.similarity;
    sums.apart += part.apart;
  }
  return sums;
}

}  // namespace

double ssim(const ColourPair& pair) {
  EDGESPLAT_CHECK(pair.consistent(), "two pictures of one size");
  const double total = 3.0 * pair.total_weight();
  return total > 0.0 ? run(pair, 0.0F, 0.0F, {}).similarity / total : 0.0;
}

SsimAndL1 ssim_l1_backward(const ColourPair& pair, float ssim_factor, float l1_factor,
                           std::span<float> by_drawn) {
  EDGESPLAT_CHECK(pair.consistent() && by_drawn.size() == pair.drawn.size(), "three pictures of one size");
  const double total = 3.0 * pair.total_weight();
  if (!(total > 0.0)) {
    std::ranges::fill(by_drawn, 0.0F);
    return {};
  }
  const auto share = [total](float factor) {
    return static_cast<float>(static_cast<double>(factor) / total);
  };
  const Sums sums = run(pair, share(ssim_factor), share(l1_factor), by_drawn);
  return {sums.similarity / total, sums.apart / total};
}

}  // namespace edgesplat::train
#endif
