// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/prune_switches.hpp"

#include "kernels/mapping/densify.hpp"
#include "kernels/mapping/relocate.hpp"
#include "kernels/train/image_measures.hpp"
#include "kernels/train/switch_math.hpp"
#include "test/kernels/mapping/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace edgesplat::mapping {
namespace {

constexpr float kFactor = 0.3F;

class PruneSwitchesTest : public testing::Test {
 protected:
  PruneSwitchesTest() : scene_(5, 120, 4) {}
  /// The scene's Gaussians, then as many that no picture needs: faint ones in their places.
  [[nodiscard]] gaussian::GaussianCloud with_useless_ones() const {
    auto cloud = scene_.truth;
    IdAllocator ids(7);
    for (std::size_t row = 0; row < kTrue; ++row) {
      cloud.append_row(scene_.truth, row);
      cloud.ids.back() = ids.next();
      cloud.opacity_logits.back() = -4.0F;
    }
    return cloud;
  }
  [[nodiscard]] Optimiser make(float factor) const {
    OptimiserOptions options;
    options.prune.factor = factor;
    auto optimiser = Optimiser::create(options, clock_);
    EXPECT_TRUE(optimiser);
    EXPECT_TRUE(optimiser->add_rows(with_useless_ones()));
    return std::move(*optimiser);
  }
  void run(Optimiser& optimiser, int steps) const {
    for (int i = 0; i < steps; ++i)
      ASSERT_TRUE(optimiser.step(scene_.shots[static_cast<std::size_t>(i) % scene_.shots.size()].training()));
  }
  [[nodiscard]] double psnr(const Optimiser& optimiser) const {
    const auto& shot = scene_.shots[0];
    std::vector<float> colour(shot.colour.size()), depth(shot.alpha.size()), alpha(shot.alpha.size());
    EXPECT_TRUE(splat::render(core::Backend::kCpu, splat::spans_of(optimiser.cloud()), shot.view, {},
                              {colour, depth, alpha}));
    return train::psnr_db({shot.view.width_px, shot.view.height_px, colour, shot.colour, {}});
  }
  static constexpr std::size_t kTrue = 120;
  AnalyticScene scene_;
  SteadyClock clock_;
};

TEST_F(PruneSwitchesTest, CloseForWhatNoPictureNeeds) {
  Optimiser optimiser = make(kFactor);
  const std::size_t before = optimiser.cloud().size();
  run(optimiser, 600);
  DensifyOptions options;
  options.gradient = 1.0F;  // no growth
  options.min_opacity = 0.0F;
  options.min_weight_px = 0.0F;
  IdAllocator ids(2);
  const DensifyReport report = densify(optimiser, options, ids);
  EXPECT_GT(report.switched_off, 0.6 * kTrue);
  EXPECT_EQ(optimiser.cloud().size(), before - report.switched_off);
  EXPECT_GT(psnr(optimiser), 30.0);
  std::size_t needed = 0;
  for (const gaussian::GaussianId id : report.removed)
    needed += std::ranges::count(scene_.truth.ids, id) > 0 ? 1U : 0U;
  // Of two in one place either may become the one that is needed.
  EXPECT_LT(needed, report.switched_off / 2);
}

TEST_F(PruneSwitchesTest, ArePartOfTheLossAndOfNothingElse) {
  Optimiser with = make(kFactor), without = make(0.0F);
  EXPECT_FALSE(without.switches().enabled());
  EXPECT_EQ(without.switches().of(0), 1.0F);
  const double extra =
      with.step(scene_.shots[0].training())->loss - without.step(scene_.shots[0].training())->loss;
  EXPECT_GT(extra, 0.85 * static_cast<double>(kFactor));
  EXPECT_LT(extra, static_cast<double>(kFactor));
  run(without, 600);
  DensifyOptions options;
  options.gradient = 1.0F;
  IdAllocator ids(2);
  EXPECT_EQ(densify(without, options, ids).switched_off, 0U);
}

TEST_F(PruneSwitchesTest, NewRowsLookAsTheyCame) {
  PruneSwitches switches({.factor = kFactor});
  const std::vector<float> drawn{-6.0F, -1.0F, 0.0F, 4.0F, 9.0F};
  switches.append(drawn);
  EXPECT_NEAR(switches.of(0), 0.9F, 1e-5F);
  const std::vector<std::uint32_t> rows{0, 1, 2, 3};
  std::vector<float> logits = drawn, values(4 * train::ParameterRow::stride(0), 0.0F);
  const train::GradientBlock block{0, rows, values, {}};
  // Without a gradient only the cost moves the switches, by one step of their rate.
  (void)switches.before_step(block, train::ParameterRow::stride(0), 0.25F, logits);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_GT(logits[i], drawn[i]) << "the base is more solid";
  switches.after_step(block, logits);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(logits[i], drawn[i]);
    EXPECT_NEAR(train::sigmoid(logits[i]), train::sigmoid(drawn[i]), 0.01F) << drawn[i];
  }
  const std::vector<std::uint32_t> kept{0, 2};
  const float third = switches.of(2);
  switches.keep_rows(kept);
  EXPECT_EQ(switches.of(1), third);
}

TEST_F(PruneSwitchesTest, RelocationTakesWhatIsSwitchedOff) {
  Optimiser optimiser = make(kFactor);
  run(optimiser, 600);
  Relocator relocator({.min_opacity = 0.0F, .grow_share = 0.0F, .max_rows = 2 * kTrue});
  IdAllocator ids(2);
  const RelocateReport report = relocator.relocate(optimiser, ids);
  EXPECT_GT(report.removed.size(), 0.6 * kTrue);
  EXPECT_EQ(report.moved, report.removed.size());
}

}  // namespace
}  // namespace edgesplat::mapping
