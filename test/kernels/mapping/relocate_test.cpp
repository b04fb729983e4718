// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/relocate.hpp"

#include "kernels/train/image_measures.hpp"
#include "test/kernels/mapping/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace edgesplat::mapping {
namespace {

/// What `copies` Gaussians of one place cover on a line through their centre, integrated.
double covered(double opacity, double sigma, std::size_t copies) {
  constexpr double kStep = 1e-3;
  double sum = 0.0;
  for (double x = -8.0; x < 8.0; x += kStep) {
    const double alpha = opacity * std::exp(-0.5 * x * x / (sigma * sigma));
    sum += kStep * (1.0 - std::pow(1.0 - alpha, static_cast<double>(copies)));
  }
  return sum;
}

TEST(SharedLook, CoversWhatOneDid) {
  for (const float opacity : {0.01F, 0.3F, 0.8F, 0.99F}) {
    for (const std::size_t copies : {std::size_t{1}, std::size_t{2}, std::size_t{5}, std::size_t{51}}) {
      const SharedLook look = shared_look(opacity, copies);
      EXPECT_NEAR(1.0 - std::pow(1.0 - static_cast<double>(look.opacity), static_cast<double>(copies)),
                  static_cast<double>(opacity), 1e-5)
          << "the centre blends to the same";
      const double before = covered(static_cast<double>(opacity), 1.0, 1);
      const double after =
          covered(static_cast<double>(look.opacity), static_cast<double>(look.scale_factor), copies);
      EXPECT_NEAR(after / before, 1.0, 1e-4) << opacity << " " << copies;
    }
  }
  EXPECT_FLOAT_EQ(shared_look(0.4F, 1).scale_factor, 1.0F);
}

class RelocateTest : public testing::Test {
 protected:
  RelocateTest() : scene_(3, 200, 2) {}
  [[nodiscard]] Optimiser make(const gaussian::GaussianCloud& rows) const {
    auto optimiser = Optimiser::create(options_, clock_);
    EXPECT_TRUE(optimiser);
    EXPECT_EQ(optimiser->add_rows(rows).value_or(0), rows.size());
    return std::move(*optimiser);
  }
  [[nodiscard]] std::vector<float> draw(const Optimiser& optimiser) const {
    const auto& shot = scene_.shots[0];
    std::vector<float> colour(shot.colour.size()), depth(shot.alpha.size()), alpha(shot.alpha.size());
    EXPECT_TRUE(splat::render(core::Backend::kCpu, splat::spans_of(optimiser.cloud()), shot.view, {},
                              {colour, depth, alpha}));
    return colour;
  }
  [[nodiscard]] double psnr(std::span<const float> a, std::span<const float> b) const {
    const auto& view = scene_.shots[0].view;
    return train::psnr_db({view.width_px, view.height_px, a, b, {}});
  }
  /// The truth, every fourth Gaussian all but transparent.
  [[nodiscard]] gaussian::GaussianCloud with_dead() const {
    gaussian::GaussianCloud cloud = scene_.truth;
    for (std::size_t row = 0; row < cloud.size(); row += 4) cloud.opacity_logits[row] = -8.0F;
    return cloud;
  }
  AnalyticScene scene_;
  OptimiserOptions options_;
  SteadyClock clock_;
  IdAllocator ids_{7, 100'000};
};

TEST_F(RelocateTest, MovesTheDeadAndKeepsThePicture) {
  Optimiser optimiser = make(with_dead());
  const auto before = draw(optimiser);
  Relocator relocator({.grow_share = 0.0F});
  const RelocateReport report = relocator.relocate(optimiser, ids_);
  EXPECT_EQ(report.removed.size(), 50U);
  EXPECT_EQ(report.moved, 50U);
  EXPECT_EQ(report.added, 0U);
  const auto& cloud = optimiser.cloud();
  ASSERT_TRUE(cloud.consistent());
  EXPECT_EQ(cloud.size(), 200U);
  EXPECT_EQ(std::set(cloud.ids.begin(), cloud.ids.end()).size(), 200U);
  for (const float logit : cloud.opacity_logits) EXPECT_GT(logit, -6.0F);
  const double shared_db = psnr(draw(optimiser), before);
  EXPECT_GT(shared_db, 33.0);
  // The same rows doubled without sharing: what the formula is for.
  gaussian::GaussianCloud doubled = with_dead();
  const std::size_t rows = doubled.size();
  for (std::size_t row = 1; row < rows; row += 4) doubled.append_row(doubled, row);
  EXPECT_LT(psnr(draw(make(doubled)), before), shared_db - 3.0);
}

TEST_F(RelocateTest, GrowsByAShareUpToTheMost) {
  Optimiser optimiser = make(scene_.truth);
  const auto before = draw(optimiser);
  Relocator relocator({.grow_share = 0.1F, .max_rows = 230});
  EXPECT_EQ(relocator.relocate(optimiser, ids_).added, 20U);
  EXPECT_EQ(relocator.relocate(optimiser, ids_).added, 10U);
  EXPECT_EQ(relocator.relocate(optimiser, ids_).added, 0U);
  EXPECT_EQ(optimiser.cloud().size(), 230U);
  EXPECT_GT(psnr(draw(optimiser), before), 33.0);
  options_.max_gaussians = 205;
  Optimiser bounded = make(scene_.truth);
  EXPECT_EQ(Relocator({.grow_share = 0.1F}).relocate(bounded, ids_).added, 5U) << "the optimiser's budget";
}

TEST_F(RelocateTest, DrawsPlacesByOpacity) {
  gaussian::GaussianCloud two;
  two.append_row(scene_.truth, 0);
  two.append_row(scene_.truth, 1);
  two.opacity_logits = {std::log(0.9F / 0.1F), std::log(0.1F / 0.9F)};
  two.means_m[0] = 1.0F;
  two.means_m[3] = 2.0F;
  std::size_t first = 0, second = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    Optimiser optimiser = make(two);
    ASSERT_EQ(Relocator({.grow_share = 0.5F, .seed = seed}).relocate(optimiser, ids_).added, 1U);
    (optimiser.cloud().means_m[6] < 1.5F ? first : second) += 1;
  }
  EXPECT_NEAR(static_cast<double>(first) / 300.0, 0.9, 0.06);
  EXPECT_EQ(first + second, 300U);
}

TEST_F(RelocateTest, LeavesAMapOfTheDeadAndAnEmptyOneAlone) {
  gaussian::GaussianCloud cloud = scene_.truth;
  for (float& logit : cloud.opacity_logits) logit = -9.0F;
  Optimiser optimiser = make(cloud);
  EXPECT_TRUE(Relocator({}).relocate(optimiser, ids_).removed.empty());
  EXPECT_EQ(optimiser.cloud().size(), 200U);
  Optimiser empty = make({});
  EXPECT_EQ(Relocator({}).relocate(empty, ids_).added, 0U);
}

TEST_F(RelocateTest, ShakesTheFaintWithinTheirExtent) {
  Optimiser optimiser = make(with_dead());
  const auto before = optimiser.cloud().means_m;
  Relocator({.noise_per_m = 1.0F}).shake(optimiser, 0.0F);
  EXPECT_EQ(optimiser.cloud().means_m, before);
  const ChangeMark mark = optimiser.mark();
  Relocator({.noise_per_m = 1.0F}).shake(optimiser, 0.5F);
  EXPECT_EQ(optimiser.changed_since(mark).size(), 50U);
  double sum = 0.0;
  for (std::size_t row = 0; row < 200; ++row) {
    double moved = 0.0, largest = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double by = static_cast<double>(optimiser.cloud().means_m[3 * row + k] - before[3 * row + k]);
      moved += by * by;
      largest = std::max(largest, std::exp(static_cast<double>(optimiser.cloud().log_scales[3 * row + k])));
    }
    if (row % 4 != 0) {
      EXPECT_EQ(moved, 0.0) << "what is seen stays";
    } else {
      EXPECT_LT(std::sqrt(moved), 0.5 * 6.0 * largest * largest) << "six sigma";
      sum += moved;
    }
  }
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace edgesplat::mapping
