// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/optimiser.hpp"

#include "kernels/train/image_measures.hpp"
#include "test/kernels/mapping/analytic_scene.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>

namespace edgesplat::mapping {
namespace {

/// Larger steps than for a live map: few of them, and a scene far off.
OptimiserOptions quick() {
  OptimiserOptions options;
  options.rates = {
      .mean_m = 3e-3F, .log_scale = 1e-2F, .quat = 5e-3F, .opacity_logit = 5e-2F, .sh_base = 1e-2F};
  return options;
}

class OptimiserTest : public testing::Test {
 protected:
  [[nodiscard]] Optimiser make(const OptimiserOptions& options, const gaussian::GaussianCloud& rows) const {
    auto optimiser = Optimiser::create(options, clock_);
    EXPECT_TRUE(optimiser);
    EXPECT_EQ(optimiser->add_rows(rows).value_or(0), rows.size());
    return std::move(*optimiser);
  }
  static double psnr(const Optimiser& optimiser, const AnalyticScene::Shot& shot) {
    std::vector<float> colour(shot.colour.size()), depth(shot.alpha.size()), alpha(shot.alpha.size());
    EXPECT_TRUE(splat::render(core::Backend::kCpu, splat::spans_of(optimiser.cloud()), shot.view, {},
                              {colour, depth, alpha}));
    return train::psnr_db({shot.view.width_px, shot.view.height_px, colour, shot.colour, {}});
  }
  static void run(Optimiser& optimiser, const AnalyticScene& scene, int steps) {
    for (int i = 0; i < steps; ++i)
      ASSERT_TRUE(optimiser.step(scene.shots[static_cast<std::size_t>(i) % scene.shots.size()].training()));
  }
  SteadyClock clock_;
};

TEST_F(OptimiserTest, RecoversAKnownSceneFromItsPictures) {
  AnalyticScene scene(1, 150, 8);
  Optimiser optimiser = make(quick(), scene.perturbed(1.0));
  const AnalyticScene::Shot unseen = scene.shoot({geometry::so3_exp({0.02, -0.03, 0.05}), {0.1, -0.1, 0.1}});
  const double before = psnr(optimiser, unseen);
  run(optimiser, scene, 800);
  for (const auto& shot : scene.shots) EXPECT_GT(psnr(optimiser, shot), 35.0);
  EXPECT_GT(psnr(optimiser, unseen), 35.0);
  EXPECT_LT(before, 25.0) << "the start was already there";
}

TEST_F(OptimiserTest, DepthPullsGaussiansToTheirPlace) {
  AnalyticScene scene(2, 100, 4);
  auto start = scene.truth;
  for (std::size_t i = 0; i < start.size(); ++i) start.means_m[3 * i + 2] += 0.1F;
  OptimiserOptions options = quick();
  options.depth_factor = 0.5F;
  Optimiser optimiser = make(options, start);
  const double before_m = optimiser.step(scene.shots[0].training())->depth_m;
  run(optimiser, scene, 200);
  EXPECT_LT(optimiser.step(scene.shots[0].training())->depth_m, 0.3 * before_m);
}

TEST_F(OptimiserTest, LearnsTheExposureOfAPicture) {
  AnalyticScene scene(3, 100, 4);
  Optimiser optimiser = make(quick(), scene.truth);
  AnalyticScene::Shot dark = scene.shots[0];
  for (float& value : dark.colour) value *= 0.7F;
  TrainingView view = dark.training();
  view.exposure_key = 5;
  for (int i = 0; i < 400; ++i) {
    ASSERT_TRUE(optimiser.step(view));
    run(optimiser, scene, 3);
  }
  EXPECT_NEAR(optimiser.exposures().of(5).gain[1], 0.7F, 0.05F);
  EXPECT_GT(psnr(optimiser, scene.shots[0]), 30.0) << "the map itself stays bright";
}

TEST_F(OptimiserTest, IsTheSameForEveryNumberOfThreads) {
  AnalyticScene scene(4, 400, 2);
  const auto start = scene.perturbed(1.0);
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Optimiser optimiser = make(quick(), start);
    run(optimiser, scene, 20);
    return optimiser.cloud();
  };
  const auto alone = with_threads(1);
  const auto together = with_threads(2);
  EXPECT_EQ(alone.means_m, together.means_m);
  EXPECT_EQ(alone.quats_xyzw, together.quats_xyzw);
  EXPECT_EQ(alone.sh, together.sh);
}

TEST_F(OptimiserTest, TellsWhichRowsChanged) {
  AnalyticScene scene(5, 50, 1);
  auto rows = scene.truth;
  rows.means_m[3 * 7 + 2] = -5.0F;  // behind the camera
  Optimiser optimiser = make(quick(), rows);
  const ChangeMark start = optimiser.mark();
  EXPECT_TRUE(optimiser.changed_since(start).empty());
  const auto report = optimiser.step(scene.shots[0].training());
  ASSERT_TRUE(report);
  const auto changed = optimiser.changed_since(start);
  EXPECT_EQ(changed.size(), report->visible);
  EXPECT_FALSE(std::binary_search(changed.begin(), changed.end(), 7U));
  const ChangeMark stepped = optimiser.mark();
  const std::vector<std::uint32_t> edited{7, 9};
  optimiser.edit_rows(edited).means_m[3 * 7] += 1.0F;
  EXPECT_EQ(optimiser.changed_since(stepped), edited);
  const ChangeMark before_adding = optimiser.mark();
  ASSERT_TRUE(optimiser.add_rows(scene.truth));
  EXPECT_EQ(optimiser.changed_since(before_adding).size(), 50U);
  EXPECT_EQ(optimiser.changed_since(before_adding).front(), 50U);
}

TEST_F(OptimiserTest, WhatIsHiddenBehindOthersStaysAsItIs) {
  AnalyticScene scene(11, 1, 1);
  auto rows = scene.truth;
  for (int i = 0; i < 6; ++i) rows.append_row(scene.truth, 0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows.means_m[3 * i] = rows.means_m[3 * i + 1] = 0.0F;
    rows.means_m[3 * i + 2] = 2.0F + static_cast<float>(i);
    std::fill_n(&rows.log_scales[3 * i], 3, 4.0F);
    rows.opacity_logits[i] = 8.0F;
  }
  Optimiser optimiser = make(quick(), rows);
  EXPECT_EQ(optimiser.step(scene.shots[0].training())->visible, 1U)
      << "two of alpha 0.99 would leave too little";
  EXPECT_EQ(optimiser.statistics()[6].sightings, 0U);
  EXPECT_EQ(optimiser.cloud().sh[3 * 6], rows.sh[3 * 6]);
}

TEST_F(OptimiserTest, RemovedRowsTakeTheirStateAlong) {
  AnalyticScene scene(6, 60, 3);
  Optimiser whole = make(quick(), scene.perturbed(1.0));
  run(whole, scene, 5);
  const auto before = whole.cloud();
  const std::vector<std::uint32_t> gone{59, 0, 30};
  ASSERT_TRUE(whole.remove_rows(gone));
  ASSERT_EQ(whole.cloud().size(), 57U);
  EXPECT_TRUE(whole.cloud().consistent());
  EXPECT_EQ(whole.cloud().ids[0], before.ids[1]);
  EXPECT_EQ(whole.cloud().ids[29], before.ids[31]);
  EXPECT_EQ(whole.statistics().size(), 57U);
  const std::vector<std::uint32_t> missing{57};
  EXPECT_FALSE(whole.remove_rows(missing));
  run(whole, scene, 5);
}

TEST_F(OptimiserTest, PadsRowsOfALowerDegreeAndRefusesAHigherOne) {
  AnalyticScene scene(7, 10, 1);
  OptimiserOptions options = quick();
  options.sh_degree = 2;
  Optimiser optimiser = make(options, scene.truth);
  EXPECT_TRUE(optimiser.cloud().consistent());
  EXPECT_EQ(optimiser.cloud().sh[27], scene.truth.sh[3]);
  EXPECT_EQ(optimiser.cloud().sh[3], 0.0F);
  run(optimiser, scene, 3);
  gaussian::GaussianCloud higher;
  higher.sh_degree = 3;
  EXPECT_FALSE(optimiser.add_rows(higher));
}

TEST_F(OptimiserTest, RaisesTheDegreeWithoutASeam) {
  AnalyticScene scene(12, 60, 2);
  gaussian::GaussianCloud start = scene.perturbed(1.0);
  Optimiser raised = make(quick(), start), plain = make(quick(), start);
  run(raised, scene, 6);
  run(plain, scene, 6);
  const ChangeMark mark = raised.mark();
  ASSERT_TRUE(raised.raise_sh_degree(2));
  ASSERT_TRUE(raised.cloud().consistent());
  EXPECT_EQ(raised.cloud().sh_degree, 2);
  EXPECT_EQ(raised.changed_since(mark).size(), raised.cloud().size());
  // New terms are zero: the picture, its gradients by the old parameters and their moments are what they
  // were.
  run(raised, scene, 1);
  run(plain, scene, 1);
  for (std::size_t i = 0; i < plain.cloud().means_m.size(); ++i)
    ASSERT_NEAR(raised.cloud().means_m[i], plain.cloud().means_m[i], 1e-6F);
  bool learns = false;
  for (std::size_t row = 0; row < plain.cloud().size(); ++row) {
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(raised.cloud().sh[27 * row + c], plain.cloud().sh[3 * row + c], 1e-5F);
    learns = learns || raised.cloud().sh[27 * row + 3] != 0.0F;
  }
  EXPECT_TRUE(learns);
  EXPECT_FALSE(raised.raise_sh_degree(1));
  EXPECT_FALSE(raised.raise_sh_degree(4));
  EXPECT_EQ(raised.cloud().sh_degree, 2);
}

TEST_F(OptimiserTest, KeepsToItsBudget) {
  AnalyticScene scene(8, 100, 1);
  OptimiserOptions options = quick();
  options.max_gaussians = 150;
  Optimiser optimiser = make(options, scene.truth);
  EXPECT_EQ(optimiser.room(), 50U);
  EXPECT_EQ(optimiser.add_rows(scene.truth).value_or(0), 50U);
  EXPECT_EQ(optimiser.rows_refused(), 50U);
  EXPECT_EQ(optimiser.cloud().size(), 150U);
  options.max_bytes = 10 * optimiser.bytes_per_row();
  auto small = Optimiser::create(options, clock_);
  EXPECT_EQ(small->add_rows(scene.truth).value_or(0), 10U);
}

TEST_F(OptimiserTest, RefusesPicturesThatDoNotFitAndBadOptions) {
  AnalyticScene scene(9, 10, 1);
  Optimiser optimiser = make(quick(), scene.truth);
  TrainingView view = scene.shots[0].training();
  view.colour = view.colour.first(30);
  ASSERT_FALSE(optimiser.step(view));
  EXPECT_EQ(optimiser.step(view).error().code, Errc::kInvalidArgument);
  OptimiserOptions options;
  options.ssim_share = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(Optimiser::create(options, clock_).error().code, Errc::kInvalidConfig);
  options = {};
  options.sh_degree = 4;
  EXPECT_FALSE(Optimiser::create(options, clock_));
}

TEST_F(OptimiserTest, AnEmptyMapAndAPictureThatDoesNotCountChangeNothing) {
  AnalyticScene scene(10, 20, 1);
  Optimiser empty = make(quick(), {});
  EXPECT_TRUE(empty.step(scene.shots[0].training()));
  Optimiser optimiser = make(quick(), scene.truth);
  TrainingView view = scene.shots[0].training();
  const std::vector<float> weight(AnalyticScene::kWidth_px * AnalyticScene::kHeight_px, 0.0F);
  view.weight = weight;
  EXPECT_EQ(optimiser.step(view)->loss, 0.0);
  EXPECT_EQ(optimiser.cloud().means_m, scene.truth.means_m);
}

}  // namespace
}  // namespace edgesplat::mapping
