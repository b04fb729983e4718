// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/losses.hpp"

#include "common/base/check.hpp"
#include "common/thread/parallel_for.hpp"
#include "kernels/core/simd_variants.hpp"
#include "kernels/train/ssim.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace edgesplat::train {
namespace {

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

struct L1Run {
  const float* __restrict drawn;
  const float* __restrict target;
  float* __restrict by_drawn;
  std::size_t count;
  float scale;
  double& sum;
};

/// L1 of a run of floats: scale times its gradient, and how far apart they are. The sums of 16 places are
/// kept apart so that the loop becomes vector operations.
EDGESPLAT_INLINE void l1_run_inline(const L1Run& run) {
  constexpr std::size_t kLanes = 16;
  float sums[kLanes] = {};
  const float scale = run.scale;
  const std::size_t whole = run.count / kLanes * kLanes;
  for (std::size_t first = 0; first < whole; first += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const float d = run.drawn[first + k] - run.target[first + k];
      sums[k] += std::abs(d);
      run.by_drawn[first + k] = d > 0.0F ? scale : (d < 0.0F ? -scale : 0.0F);
    }
  }
  for (std::size_t i = whole; i < run.count; ++i) {
    const float d = run.drawn[i] - run.target[i];
    sums[i - whole] += std::abs(d);
    run.by_drawn[i] = d > 0.0F ? scale : (d < 0.0F ? -scale : 0.0F);
  }
  double sum = 0.0;
  for (const float part : sums) sum += static_cast<double>(part);
  run.sum = sum;
}

EDGESPLAT_SIMD_VARIANTS(l1_run, (const L1Run& run), (run))

double l1_backward(const ColourPair& pair, float scale, std::span<float> by_drawn) {
  const auto l1_run = fastest_l1_run();
  return sum_over_blocks(pair.pixels(), [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    if (pair.weight.empty()) {
      l1_run({&pair.drawn[3 * first], &pair.target[3 * first], &by_drawn[3 * first], 3 * (last - first),
              scale, sum});
      return sum;
    }
    for (std::size_t pixel = first; pixel < last; ++pixel) {
      const float w = pair.weight[pixel];
      double apart = 0.0;
      l1_run({&pair.drawn[3 * pixel], &pair.target[3 * pixel], &by_drawn[3 * pixel], 3, scale * w, apart});
      sum += static_cast<double>(w) * apart;
    }
    return sum;
  });
}

/// A pixel that has a measurement and enough coverage.
bool counts(const DepthPair& pair, std::size_t pixel, float min_alpha) {
  const float target = pair.target_m[pixel];
  return target > 0.0F && std::isfinite(target) && pair.alpha[pixel] >= min_alpha;
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
  loss.l1 = l1_backward(pair, static_cast<float>((1.0 - share) / total), by_drawn) / total;
  loss.value = (1.0 - share) * loss.l1;
  if (ssim_share > 0.0F) {
    loss.ssim = ssim_backward(pair, -ssim_share, by_drawn);
    loss.value += share * (1.0 - loss.ssim);
  }
  return loss;
}

double depth_loss(const DepthPair& pair, float factor, float min_alpha, std::span<float> by_depth_sum,
                  std::span<float> by_alpha) {
  const std::size_t pixels = pair.depth_sum_m.size();
  EDGESPLAT_CHECK(pair.alpha.size() == pixels && pair.target_m.size() == pixels &&
                      (pair.weight.empty() || pair.weight.size() == pixels) &&
                      by_depth_sum.size() == pixels && by_alpha.size() == pixels,
                  "pictures of one size");
  const auto weight = [&pair](std::size_t pixel) { return pair.weight.empty() ? 1.0F : pair.weight[pixel]; };
  const double total = sum_over_blocks(pixels, [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      if (counts(pair, i, min_alpha)) sum += static_cast<double>(weight(i));
    }
    return sum;
  });
  const float scale = total > 0.0 ? static_cast<float>(static_cast<double>(factor) / total) : 0.0F;
  const double sum = sum_over_blocks(pixels, [&](std::size_t first, std::size_t last) {
    double apart = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      by_depth_sum[i] = by_alpha[i] = 0.0F;
      if (!counts(pair, i, min_alpha)) continue;
      const float depth_m = pair.depth_sum_m[i] / pair.alpha[i];
      const float d = depth_m - pair.target_m[i];
      const float by_depth = scale * weight(i) * (d > 0.0F ? 1.0F : (d < 0.0F ? -1.0F : 0.0F));
      by_depth_sum[i] = by_depth / pair.alpha[i];
      by_alpha[i] = -by_depth * depth_m / pair.alpha[i];
      apart += static_cast<double>(weight(i) * std::abs(d));
    }
    return apart;
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
