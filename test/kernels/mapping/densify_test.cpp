// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/densify.hpp"

#include "kernels/train/image_measures.hpp"
#include "test/kernels/mapping/analytic_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace edgesplat::mapping {
namespace {

class DensifyTest : public testing::Test {
 protected:
  DensifyTest() : scene_(1, 200, 4) {
    options_.rates = {
        .mean_m = 3e-3F, .log_scale = 1e-2F, .quat = 5e-3F, .opacity_logit = 5e-2F, .sh_base = 1e-2F};
  }
  [[nodiscard]] Optimiser make(const gaussian::GaussianCloud& rows) const {
    auto optimiser = Optimiser::create(options_, clock_);
    EXPECT_TRUE(optimiser);
    EXPECT_EQ(optimiser->add_rows(rows).value_or(0), rows.size());
    return std::move(*optimiser);
  }
  void run(Optimiser& optimiser, int steps) const {
    for (int i = 0; i < steps; ++i)
      ASSERT_TRUE(optimiser.step(scene_.shots[static_cast<std::size_t>(i) % scene_.shots.size()].training()));
  }
  [[nodiscard]] std::vector<float> draw(const Optimiser& optimiser) const {
    const auto& shot = scene_.shots[0];
    std::vector<float> colour(shot.colour.size()), depth(shot.alpha.size()), alpha(shot.alpha.size());
    EXPECT_TRUE(splat::render(core::Backend::kCpu, splat::spans_of(optimiser.cloud()), shot.view, {},
                              {colour, depth, alpha}));
    return colour;
  }
  [[nodiscard]] double psnr(const Optimiser& optimiser) const {
    const auto& shot = scene_.shots[0];
    return train::psnr_db({shot.view.width_px, shot.view.height_px, draw(optimiser), shot.colour, {}});
  }
  /// Every tenth Gaussian of the truth, three times as large: too few for the picture.
  [[nodiscard]] gaussian::GaussianCloud coarse() const {
    gaussian::GaussianCloud cloud;
    for (std::size_t i = 0; i < scene_.truth.size(); i += 10) cloud.append_row(scene_.truth, i);
    for (float& s : cloud.log_scales) s += 1.1F;
    for (std::size_t i = 0; i < cloud.size(); ++i) cloud.anchors[i] = {static_cast<std::uint32_t>(i), 3};
    return cloud;
  }
  AnalyticScene scene_;
  OptimiserOptions options_;
  SteadyClock clock_;
  IdAllocator ids_{7, 1000};
};

TEST_F(DensifyTest, GrowsWhereThePicturesDisagree) {
  Optimiser alone = make(coarse());
  Optimiser grown = make(coarse());
  DensifyOptions options;
  options.grow_share = 0.5F;
  run(alone, 400);
  for (int round = 0; round < 8; ++round) {
    run(grown, 50);
    densify(grown, options, ids_);
  }
  EXPECT_GT(grown.cloud().size(), 2 * alone.cloud().size());
  EXPECT_GT(psnr(grown), psnr(alone) + 1.5);
}

TEST_F(DensifyTest, GivesNewIdsAndTheParentsAnchor) {
  Optimiser optimiser = make(coarse());
  const std::size_t before = optimiser.cloud().size();
  run(optimiser, 20);
  DensifyOptions options;
  options.gradient = 1e-7F;
  options.grow_share = 1.0F;
  const ChangeMark mark = optimiser.mark();
  const DensifyReport report = densify(optimiser, options, ids_);
  const auto& cloud = optimiser.cloud();
  ASSERT_TRUE(cloud.consistent());
  EXPECT_GT(report.cloned + report.split, before / 2);
  EXPECT_EQ(cloud.size(), before - report.removed.size() + report.cloned + report.split);
  EXPECT_EQ(std::set(cloud.ids.begin(), cloud.ids.end()).size(), cloud.size());
  for (std::size_t row = before - report.removed.size(); row < cloud.size(); ++row) {
    EXPECT_EQ(cloud.ids[row].origin(), 7U);
    EXPECT_EQ(cloud.anchors[row].pose_version, 3U);
  }
  EXPECT_GE(optimiser.changed_since(mark).size(), 2 * (report.cloned + report.split));
  for (const RowStatistics& s : optimiser.statistics()) EXPECT_EQ(s.sightings, 0U);
  run(optimiser, 5);
}

TEST_F(DensifyTest, CloningHardlyChangesThePicture) {
  Optimiser optimiser = make(scene_.truth);
  run(optimiser, 8);
  const std::vector<float> before = draw(optimiser);
  DensifyOptions options;
  options.gradient = 0.0F;
  options.grow_share = 1.0F;
  options.split_sigma_m = 10.0F;
  options.min_weight_px = 0.0F;
  const DensifyReport report = densify(optimiser, options, ids_);
  ASSERT_GT(report.cloned, 50U);
  EXPECT_EQ(report.split, 0U);
  const auto& shot = scene_.shots[0];
  EXPECT_GT(train::psnr_db({shot.view.width_px, shot.view.height_px, draw(optimiser), before, {}}), 27.0)
      << "all at once; the shared opacity is exact at the centre only";
}

TEST_F(DensifyTest, ASplitKeepsCentreAndSpread) {
  gaussian::GaussianCloud one;
  one.append_row(scene_.truth, 0);
  one.means_m = {0.0F, 0.0F, 4.0F};
  one.log_scales = {std::log(0.1F), std::log(0.4F), std::log(0.1F)};
  one.opacity_logits = {2.0F};
  Optimiser optimiser = make(one);
  run(optimiser, 4);
  const auto parent = optimiser.cloud();
  DensifyOptions options;
  options.gradient = 0.0F;
  options.grow_share = 1.0F;
  ASSERT_EQ(densify(optimiser, options, ids_).split, 1U);
  const auto& cloud = optimiser.cloud();
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.ids[0], parent.ids[0]) << "the parent lives on as one half";
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(0.5F * (cloud.means_m[k] + cloud.means_m[3 + k]), parent.means_m[k], 1e-5F);
  EXPECT_NEAR(cloud.log_scales[1] - parent.log_scales[1], std::log(0.7F), 1e-5F);
  EXPECT_EQ(cloud.log_scales[0], parent.log_scales[0]);
}

TEST_F(DensifyTest, RemovesWhatIsTransparentLargeOrIdle) {
  auto rows = scene_.truth;
  rows.opacity_logits[0] = -9.0F;
  rows.log_scales[3] = 3.0F;
  Optimiser optimiser = make(rows);
  run(optimiser, 1);
  DensifyOptions options;
  options.gradient = 1e9F;
  const auto gone0 = rows.ids[0], gone1 = rows.ids[1];
  const DensifyReport report = densify(optimiser, options, ids_);
  EXPECT_EQ(report.transparent, 1U);
  EXPECT_GE(report.large, 1U);
  EXPECT_TRUE(std::count(report.removed.begin(), report.removed.end(), gone0));
  EXPECT_TRUE(std::count(report.removed.begin(), report.removed.end(), gone1));
  EXPECT_EQ(optimiser.cloud().size(), rows.size() - report.removed.size());
  run(optimiser, 8);
  options.min_weight_px = 10.0F;
  EXPECT_GT(densify(optimiser, options, ids_).idle, 0U);
}

TEST_F(DensifyTest, KeepsToTheBudgetAndMakesRoomByShedding) {
  options_.max_gaussians = scene_.truth.size();
  Optimiser optimiser = make(scene_.perturbed(1.0));
  DensifyOptions options;
  options.gradient = 5e-4F;
  options.shed_share = 0.1F;
  options.min_sightings = 2;
  std::size_t shed = 0, grown = 0;
  for (int round = 0; round < 6; ++round) {
    run(optimiser, 10);
    const DensifyReport report = densify(optimiser, options, ids_);
    shed += report.shed;
    grown += report.cloned + report.split;
    ASSERT_LE(optimiser.cloud().size(), options_.max_gaussians);
  }
  EXPECT_GT(shed, 0U);
  EXPECT_GT(grown, 0U);
  EXPECT_EQ(optimiser.rows_refused(), 0U);
}

TEST_F(DensifyTest, AnEmptyMapStaysEmpty) {
  Optimiser optimiser = make({});
  EXPECT_TRUE(densify(optimiser, {}, ids_).removed.empty());
  EXPECT_EQ(optimiser.cloud().size(), 0U);
}

}  // namespace
}  // namespace edgesplat::mapping
