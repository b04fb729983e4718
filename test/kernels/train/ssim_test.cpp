// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/ssim.hpp"

#include "test/support/random.hpp"
#include "test/support/reference/ssim_reference.hpp"
#include "test/support/simd_limit.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

namespace edgesplat::train {
namespace {

struct Pictures {
  Pictures(std::uint64_t seed, int width, int height, bool weighted) : width_px(width), height_px(height) {
    test::Random random(seed);
    const auto pixels = static_cast<std::size_t>(width * height);
    for (std::size_t i = 0; i < 3 * pixels; ++i) {
      const double base = 0.5 + 0.4 * std::sin(0.05 * static_cast<double>(i));
      drawn.push_back(static_cast<float>(base + 0.1 * random.normal()));
      target.push_back(static_cast<float>(base + 0.1 * random.normal()));
    }
    if (!weighted) return;
    for (std::size_t i = 0; i < pixels; ++i)
      weight.push_back(i % 7 == 0 ? 0.0F : static_cast<float>(random.uniform()));
  }
  [[nodiscard]] ColourPair pair() const { return {width_px, height_px, drawn, target, weight}; }
  [[nodiscard]] double reference(const std::vector<double>& x) const {
    const std::vector<double> y(target.begin(), target.end());
    std::vector<double> w(weight.begin(), weight.end());
    if (w.empty()) w.assign(drawn.size() / 3, 1.0);
    return test::reference_ssim(width_px, height_px, x, y, w);
  }
  int width_px, height_px;
  std::vector<float> drawn, target, weight;
};

struct SsimCase {
  int width_px, height_px;
  bool weighted;
};
class Ssim : public testing::TestWithParam<std::tuple<core::SimdLevel, SsimCase>> {
 protected:
  [[nodiscard]] static const SsimCase& size_case() { return std::get<1>(GetParam()); }
  test::SimdLimit limit_{std::get<0>(GetParam())};
};

TEST_P(Ssim, ValueAgreesWithTheReference) {
  const SsimCase& c = size_case();
  const Pictures p(1, c.width_px, c.height_px, c.weighted);
  const double expected = p.reference({p.drawn.begin(), p.drawn.end()});
  EXPECT_NEAR(ssim(p.pair()), expected, 2e-5);
  std::vector<float> by_drawn(p.drawn.size());
  EXPECT_NEAR(ssim_l1_backward(p.pair(), 1.0F, 0.0F, by_drawn).ssim, expected, 2e-5);
}

TEST_P(Ssim, GradientAgreesWithDifferences) {
  const SsimCase& c = size_case();
  const Pictures p(2, c.width_px, c.height_px, c.weighted);
  constexpr float kFactor = 3.0F, kStale = 7.0F;  // outputs must be written whole
  std::vector<float> by_drawn(p.drawn.size(), kStale);
  ssim_l1_backward(p.pair(), kFactor, 0.0F, by_drawn);
  std::vector<double> x(p.drawn.begin(), p.drawn.end());
  test::Random random(3);
  const double typical = 1.0 / static_cast<double>(p.drawn.size());
  for (int n = 0; n < 12; ++n) {
    // A few at the edges of the picture and of the pieces that it is worked on in, the others anywhere.
    const std::size_t i = n == 0 ? 0 : (n == 1 ? x.size() - 1 : random.below(x.size()));
    const double before = x[i];
    x[i] = before + 1e-4;
    const double above = p.reference(x);
    x[i] = before - 1e-4;
    const double below = p.reference(x);
    x[i] = before;
    const double expected = static_cast<double>(kFactor) * (above - below) / 2e-4;
    EXPECT_NEAR(static_cast<double>(by_drawn[i]), expected,
                2e-3 * std::abs(expected) + 2e-3 * typical + 1e-7);
  }
}

TEST_P(Ssim, L1BesideItAgreesWithTheFormula) {
  const SsimCase& c = size_case();
  const Pictures p(4, c.width_px, c.height_px, c.weighted);
  std::vector<float> by_drawn(p.drawn.size());
  const double l1 = ssim_l1_backward(p.pair(), 0.0F, 2.0F, by_drawn).l1;
  double total = 0.0, apart = 0.0;
  const auto weight = [&p](std::size_t i) { return p.weight.empty() ? 1.0F : p.weight[i / 3]; };
  for (std::size_t i = 0; i < p.drawn.size(); ++i) {
    total += static_cast<double>(weight(i));
    apart += static_cast<double>(weight(i) * std::abs(p.drawn[i] - p.target[i]));
  }
  EXPECT_NEAR(l1, apart / total, 1e-5 * apart / total);
  for (std::size_t i = 0; i < p.drawn.size(); ++i) {
    const float d = p.drawn[i] - p.target[i];
    const double expected =
        2.0 / total * static_cast<double>(weight(i)) * (d > 0.0F ? 1.0 : (d < 0.0F ? -1.0 : 0.0));
    ASSERT_NEAR(static_cast<double>(by_drawn[i]), expected, 1e-5 / total) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, Ssim,
                         testing::Combine(testing::ValuesIn(core::available_simd_levels()),
                                          testing::Values(SsimCase{1, 1, false}, SsimCase{7, 4, false},
                                                          SsimCase{40, 30, false}, SsimCase{40, 30, true},
                                                          SsimCase{137, 141, false}, SsimCase{131, 130, true},
                                                          SsimCase{128, 128, false})),
                         [](const auto& param) {
                           const SsimCase& c = std::get<1>(param.param);
                           return std::string(core::to_string(std::get<0>(param.param))) + "_" +
                                  std::to_string(c.width_px) + "x" + std::to_string(c.height_px) +
                                  (c.weighted ? "_weighted" : "");
                         });

TEST(SsimValue, OfAPictureWithItselfIsOne) {
  Pictures p(4, 50, 40, false);
  p.target = p.drawn;
  EXPECT_NEAR(ssim(p.pair()), 1.0, 1e-6);
}

TEST(SsimValue, WhatDoesNotCountChangesNothing) {
  Pictures p(5, 50, 40, true);
  const double before = ssim(p.pair());
  for (std::size_t i = 0; i < p.weight.size(); ++i)
    if (p.weight[i] == 0.0F) std::fill_n(&p.drawn[3 * i], 3, 9.0F);
  EXPECT_EQ(ssim(p.pair()), before);
  std::fill(p.weight.begin(), p.weight.end(), 0.0F);
  EXPECT_EQ(ssim(p.pair()), 0.0) << "nothing counts";
}

TEST(SsimValue, IsTheSameForEveryNumberOfThreads) {
  const Pictures p(6, 300, 200, false);
  const auto with_threads = [&p](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<float> by_drawn(p.drawn.size());
    return std::pair(ssim_l1_backward(p.pair(), 1.0F, 0.5F, by_drawn).ssim, by_drawn);
  };
  EXPECT_EQ(with_threads(1), with_threads(2));
}

}  // namespace
}  // namespace edgesplat::train
