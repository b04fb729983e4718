// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/losses.hpp"

#include "common/base/check.hpp"
#include "common/thread/parallel_for.hpp"
#include "kernels/core/simd.hpp"
#include "kernels/train/ssim.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/train/losses.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include "kernels/core/vectors-inl.hpp"

#include <hwy/highway.h>

#ifndef EDGESPLAT_KERNELS_TRAIN_LOSSES_ONCE
#define EDGESPLAT_KERNELS_TRAIN_LOSSES_ONCE
namespace edgesplat::train {

struct L1Run {
  const float* drawn;
  const float* target;
  float* by_drawn;
  std::size_t count;  ///< of floats
  float scale;
};

struct DepthRun {
  const float* depth_sum_m;
  const float* alpha;
  const float* target_m;
  const float* weight;  ///< null: all 1
  float* by_depth_sum;
  float* by_alpha;
  std::size_t count;  ///< of pixels
  float scale;
  float min_alpha;
};

}  // namespace edgesplat::train
#endif

HWY_BEFORE_NAMESPACE();
namespace edgesplat::train::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

/// Runs `work` over registers of pixels; the last ones, fewer than a register, go through a copy.
template <typename Work>
HWY_INLINE void over_registers(std::size_t count, const Work& work) {
  const std::size_t lanes = hn::Lanes(D());
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) work(i, lanes);
  if (i < count) work(i, count - i);
}
HWY_INLINE V load(const float* from, std::size_t some) {
  return core::HWY_NAMESPACE::load_some(D(), from, some);
}
HWY_INLINE void store(V values, float* to, std::size_t some) {
  core::HWY_NAMESPACE::store_some(D(), values, to, some);
}
/// 1, 0 or -1 times `size`.
HWY_INLINE V with_sign_of(V difference, V size) {
  return hn::IfThenElseZero(hn::Ne(difference, hn::Zero(D())), hn::CopySign(size, difference));
}

/// L1 of a run of floats: scale times its gradient; returns how far apart they are.
double l1_run(const L1Run& run) {
  const D d;
  const V scale = hn::Set(d, run.scale);
  V sum = hn::Zero(d);
  over_registers(run.count, [&](std::size_t i, std::size_t some) HWY_ATTR {
    const V apart = hn::Sub(load(run.drawn + i, some), load(run.target + i, some));
    sum = hn::Add(sum, hn::Abs(apart));
    store(with_sign_of(apart, scale), run.by_drawn + i, some);
  });
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, sum)));
}

/// Weight of the pixels of a register that have a measurement and enough coverage, 0 for the others.
HWY_INLINE V depth_weight(const DepthRun& run, std::size_t i, std::size_t some, V alpha, V target) {
  const D d;
  const auto counts = hn::And(hn::And(hn::Gt(target, hn::Zero(d)),
                                      hn::Lt(target, hn::Set(d, std::numeric_limits<float>::infinity()))),
                              hn::Ge(alpha, hn::Set(d, run.min_alpha)));
  const V one = hn::Set(d, 1.0F);
  return hn::IfThenElseZero(counts, run.weight == nullptr ? one : load(run.weight + i, some));
}

double depth_total(const DepthRun& run) {
  const D d;
  V sum = hn::Zero(d);
  over_registers(run.count, [&](std::size_t i, std::size_t some) HWY_ATTR {
    sum = hn::Add(sum, depth_weight(run, i, some, load(run.alpha + i, some), load(run.target_m + i, some)));
  });
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, sum)));
}

/// Weighted sum of how far apart the depths are.
double depth_run(const DepthRun& run) {
  const D d;
  const V one = hn::Set(d, 1.0F), scale = hn::Set(d, run.scale);
  V sum = hn::Zero(d);
  over_registers(run.count, [&](std::size_t i, std::size_t some) HWY_ATTR {
    const V alpha = load(run.alpha + i, some), target = load(run.target_m + i, some);
    const V weight = depth_weight(run, i, some, alpha, target);
    const auto counts = hn::Gt(weight, hn::Zero(d));
    const V inverse = hn::Div(one, hn::IfThenElse(counts, alpha, one));
    const V depth = hn::Mul(load(run.depth_sum_m + i, some), inverse);
    const V apart = hn::IfThenElseZero(counts, hn::Sub(depth, target));
    const V by_depth = hn::Mul(with_sign_of(apart, hn::Mul(scale, weight)), inverse);
    sum = hn::MulAdd(weight, hn::Abs(apart), sum);
    store(by_depth, run.by_depth_sum + i, some);
    store(hn::IfThenElseZero(counts, hn::Neg(hn::Mul(by_depth, depth))), run.by_alpha + i, some);
  });
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, sum)));
}

}  // namespace edgesplat::train::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgesplat::train {
namespace {

HWY_EXPORT(l1_run);
HWY_EXPORT(depth_total);
HWY_EXPORT(depth_run);

constexpr std::size_t kBlock = std::size_t{1} << 14U;  ///< pixels

/// Runs `block(first, last)` over the pixels and adds up what it returns in a fixed order.
template <typename Block>
double sum_over_blocks(std::size_t pixels, const Block& block) {
  std::vector<double> sums((pixels + kBlock - 1) / kBlock);
  thread::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t b) {
    sums[b] = block(b * kBlock, std::min(pixels, (b + 1) * kBlock));
  });
  double sum = 0.0;
  for (const double part : sums) sum += part;
  return sum;
}

double l1_backward(const ColourPair& pair, float scale, std::span<float> by_drawn) {
  const auto l1_run = HWY_DYNAMIC_DISPATCH(l1_run);
  return sum_over_blocks(pair.pixels(), [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    if (pair.weight.empty()) {
      return l1_run(
          {&pair.drawn[3 * first], &pair.target[3 * first], &by_drawn[3 * first], 3 * (last - first), scale});
    }
    for (std::size_t pixel = first; pixel < last; ++pixel) {
      const float w = pair.weight[pixel];
      sum += static_cast<double>(w) *
             l1_run({&pair.drawn[3 * pixel], &pair.target[3 * pixel], &by_drawn[3 * pixel], 3, scale * w});
    }
    return sum;
  });
}

}  // namespace

ColourLoss colour_loss(const ColourPair& pair, float ssim_share, std::span<float> by_drawn) {
  EDGESPLAT_CHECK(pair.consistent() && by_drawn.size() == pair.drawn.size(), "three pictures of one size");
  ColourLoss loss;
  const double total = 3.0 * pair.total_weight();
  if (!(total > 0.0)) {
    std::fill(by_drawn.begin(), by_drawn.end(), 0.0F);
    return loss;
  }
  const auto share = static_cast<double>(ssim_share);
  if (ssim_share > 0.0F) {
    const SsimAndL1 both = ssim_l1_backward(pair, -ssim_share, 1.0F - ssim_share, by_drawn);
    loss.l1 = both.l1;
    loss.ssim = both.ssim;
  } else {
    loss.l1 = l1_backward(pair, static_cast<float>(1.0 / total), by_drawn) / total;
  }
  loss.value = (1.0 - share) * loss.l1 + (ssim_share > 0.0F ? share * (1.0 - loss.ssim) : 0.0);
  return loss;
}

double depth_loss(const DepthPair& pair, float factor, float min_alpha, std::span<float> by_depth_sum,
                  std::span<float> by_alpha) {
  const std::size_t pixels = pair.depth_sum_m.size();
  EDGESPLAT_CHECK(pair.alpha.size() == pixels && pair.target_m.size() == pixels &&
                      (pair.weight.empty() || pair.weight.size() == pixels) &&
                      by_depth_sum.size() == pixels && by_alpha.size() == pixels,
                  "pictures of one size");
  const auto run_of = [&](std::size_t first, std::size_t last, float scale) {
    return DepthRun{&pair.depth_sum_m[first],
                    &pair.alpha[first],
                    &pair.target_m[first],
                    pair.weight.empty() ? nullptr : &pair.weight[first],
                    &by_depth_sum[first],
                    &by_alpha[first],
                    last - first,
                    scale,
                    min_alpha};
  };
  const double total = sum_over_blocks(pixels, [&](std::size_t first, std::size_t last) {
    return HWY_DYNAMIC_DISPATCH(depth_total)(run_of(first, last, 0.0F));
  });
  const float scale = total > 0.0 ? static_cast<float>(static_cast<double>(factor) / total) : 0.0F;
  const double sum = sum_over_blocks(pixels, [&](std::size_t first, std::size_t last) {
    return HWY_DYNAMIC_DISPATCH(depth_run)(run_of(first, last, scale));
  });
  return total > 0.0 ? sum / total : 0.0;
}

double add_gap_loss(std::span<const float> alpha, std::span<const float> weight, float factor,
                    std::span<float> by_alpha) {
  EDGESPLAT_CHECK(by_alpha.size() == alpha.size() && (weight.empty() || weight.size() == alpha.size()),
                  "pictures of one size");
  const auto weight_of = [&](std::size_t pixel) { return weight.empty() ? 1.0F : weight[pixel]; };
  const double total = sum_over_blocks(alpha.size(), [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) sum += static_cast<double>(weight_of(i));
    return sum;
  });
  if (total <= 0.0) return 0.0;
  const auto slope = static_cast<float>(static_cast<double>(factor) / total);
  const double open = sum_over_blocks(alpha.size(), [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      by_alpha[i] -= slope * weight_of(i);
      sum += static_cast<double>(weight_of(i) * (1.0F - alpha[i]));
    }
    return sum;
  });
  return open / total;
}

}  // namespace edgesplat::train
#endif
