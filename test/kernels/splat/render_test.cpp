// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/render.hpp"

#include "test/support/random_cloud.hpp"
#include "test/support/reference/splat_reference.hpp"
#include "test/support/simd_limit.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <string>
#include <tuple>

namespace edgesplat::splat {
namespace {

geometry::CameraModel camera(int width_px, int height_px) {
  return {geometry::CameraKind::kPinhole,
          width_px,
          height_px,
          0.8 * width_px,
          0.8 * width_px,
          0.5 * width_px - 0.8,
          0.5 * height_px + 0.3,
          {}};
}

struct Picture {
  std::vector<float> colour, depth_sum_m, alpha;
  RenderStats stats;
};

Picture draw(const gaussian::GaussianCloud& cloud, const geometry::CameraModel& model,
             const geometry::RigidTransform& camera_from_map, const RenderOptions& options = {}) {
  const Result<View> view = View::from(model, camera_from_map);
  EXPECT_TRUE(view);
  const auto pixels = static_cast<std::size_t>(model.width_px * model.height_px);
  constexpr float kStale = 7.0F;  // outputs must be written whole
  Picture out{std::vector<float>(3 * pixels, kStale),
              std::vector<float>(pixels, kStale),
              std::vector<float>(pixels, kStale),
              {}};
  const auto stats =
      render(core::Backend::kCpu, spans_of(cloud), *view, options, {out.colour, out.depth_sum_m, out.alpha});
  EXPECT_TRUE(stats);
  if (stats) out.stats = *stats;
  return out;
}

gaussian::GaussianCloud one(const Eigen::Vector3f& mean, float scale_m, float logit) {
  gaussian::GaussianCloud cloud;
  cloud.resize(1);
  for (std::size_t i = 0; i < 3; ++i) {
    cloud.means_m[i] = mean[static_cast<Eigen::Index>(i)];
    cloud.log_scales[i] = std::log(scale_m);
    cloud.sh[i] = 1.0F;
  }
  cloud.quats_xyzw[3] = 1.0F;
  cloud.opacity_logits[0] = logit;
  return cloud;
}

struct ReferenceCase {
  std::uint64_t seed;
  std::size_t count;
  int sh_degree;
  int width_px, height_px;
  double scale_max_m;
  bool fisheye = false, antialiased = false;
  float least_axis_px = 0.0F;
};
class AgainstReference : public testing::TestWithParam<std::tuple<core::SimdLevel, ReferenceCase>> {
 protected:
  test::SimdLimit limit_{std::get<0>(GetParam())};
};

/// Thresholds (1/255, 1e-4) may fall on the other side in single precision: such a pixel is off by at most
/// the weight of one splat there, 1/255 times its colour or depth. All others agree to rounding.
void expect_agrees(float drawn, double expected, double one_splat, double& sum) {
  ASSERT_LE(std::abs(drawn - expected), one_splat / 255.0 + 2e-4 * (1.0 + one_splat));
  sum += std::abs(drawn - expected);
}

TEST_P(AgainstReference, EveryPixelAgrees) {
  const ReferenceCase& c = std::get<1>(GetParam());
  test::Random random(c.seed);
  test::CloudShape shape;
  shape.count = c.count;
  shape.sh_degree = c.sh_degree;
  shape.scale_max_m = c.scale_max_m;
  const auto cloud = test::random_cloud(random, shape);
  const geometry::RigidTransform pose{geometry::so3_exp(random.vector(0.3)), random.vector(0.5)};
  RenderOptions options;
  options.background = {0.2F, 0.4F, 0.9F};
  test::ReferenceOptions reference_options;
  reference_options.background = {0.2F, 0.4F, 0.9F};
  options.antialiased = reference_options.antialiased = c.antialiased;
  options.least_axis_px = c.least_axis_px;
  reference_options.least_axis_px = c.least_axis_px;
  auto model = camera(c.width_px, c.height_px);
  if (c.fisheye) {
    model.kind = geometry::CameraKind::kFisheye;
    model.fx_px = model.fy_px = 0.32 * c.width_px;  // 180 degrees across
  }
  const Picture drawn = draw(cloud, model, pose, options);
  const auto expected = test::reference_render(cloud, model, pose, reference_options);
  constexpr double kBrightest = 4.0, kFarthest_m = 12.0;
  double colour_sum = 0.0, depth_sum = 0.0, alpha_sum = 0.0;
  for (std::size_t i = 0; i < expected.alpha.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      expect_agrees(drawn.colour[3 * i + k], expected.colour[i][static_cast<Eigen::Index>(k)], kBrightest,
                    colour_sum);
    }
    expect_agrees(drawn.depth_sum_m[i], expected.depth_sum_m[i], kFarthest_m, depth_sum);
    expect_agrees(drawn.alpha[i], expected.alpha[i], 1.0, alpha_sum);
  }
  const auto pixels = static_cast<double>(expected.alpha.size());
  EXPECT_LT(colour_sum / (3.0 * pixels), 2e-5);
  EXPECT_LT(depth_sum / pixels, 1e-4);
  EXPECT_LT(alpha_sum / pixels, 1e-5);
  EXPECT_GT(drawn.stats.visible, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    Clouds, AgainstReference,
    testing::Combine(
        testing::ValuesIn(core::available_simd_levels()),
        testing::Values(ReferenceCase{1, 4, 0, 33, 17, 0.3}, ReferenceCase{2, 300, 0, 64, 48, 0.3},
                        ReferenceCase{3, 300, 1, 65, 47, 0.3}, ReferenceCase{4, 300, 2, 50, 50, 1.0},
                        ReferenceCase{5, 300, 3, 64, 64, 0.05}, ReferenceCase{6, 1500, 3, 72, 40, 2.0},
                        ReferenceCase{7, 50, 0, 1, 1, 2.0},
                        ReferenceCase{8, 300, 1, 64, 64, 0.1, false, true},
                        ReferenceCase{9, 600, 2, 80, 60, 0.3, true},
                        ReferenceCase{10, 600, 0, 65, 65, 0.1, true, true},
                        ReferenceCase{11, 900, 1, 64, 48, 0.1, false, false, 2.0F},
                        ReferenceCase{12, 900, 0, 65, 65, 0.1, true, true, 1.5F})),
    [](const auto& param) {
      return std::string(core::to_string(std::get<0>(param.param))) + "_" +
             std::to_string(std::get<1>(param.param).seed);
    });

/// Every splat covers every tile, and some are needles a thousand times as long as thick.
TEST(Render, GiantsAndNeedlesAgreeWithTheReference) {
  for (const core::SimdLevel level : core::available_simd_levels()) {
    const test::SimdLimit limit(level);
    test::Random random(31);
    auto cloud =
        test::random_cloud(random, {.count = 40, .sh_degree = 1, .scale_min_m = 2.0, .scale_max_m = 9.0});
    for (std::size_t i = 0; i < cloud.size(); i += 2) {
      cloud.log_scales[3 * i] = std::log(8.0F);
      cloud.log_scales[3 * i + 1] = cloud.log_scales[3 * i + 2] = std::log(0.008F);
    }
    const auto model = camera(96, 80);
    const Picture drawn = draw(cloud, model, {});
    const auto expected = test::reference_render(cloud, model, {}, {});
    double sum = 0.0;
    for (std::size_t i = 0; i < expected.alpha.size(); ++i)
      expect_agrees(drawn.alpha[i], expected.alpha[i], 1.0, sum);
    EXPECT_LT(sum / static_cast<double>(expected.alpha.size()), 2e-5) << core::to_string(level);
  }
}

/// A wall of small Gaussians seen from far away: few stand for all of them.
TEST(Render, AThinnedWallLooksLikeTheWholeOne) {
  constexpr int kAcross = 200;
  gaussian::GaussianCloud wall;
  wall.resize(kAcross * kAcross);
  test::Random random(5);
  for (std::size_t i = 0; i < wall.size(); ++i) {
    const std::size_t line = i / kAcross;
    const auto column = static_cast<float>(i % kAcross), row = static_cast<float>(line);
    const float jitter = static_cast<float>(random.uniform(-0.5, 0.5));
    wall.means_m[3 * i] = 0.02F * (column + jitter - kAcross / 2.0F);
    wall.means_m[3 * i + 1] = 0.02F * (row - kAcross / 2.0F);
    wall.means_m[3 * i + 2] = 8.0F;
    for (std::size_t k = 0; k < 3; ++k) {
      wall.log_scales[3 * i + k] = std::log(0.012F);
      wall.sh[3 * i + k] = std::sin(0.05F * column + static_cast<float>(k)) * std::cos(0.04F * row);
    }
    wall.quats_xyzw[4 * i + 3] = 1.0F;
    wall.opacity_logits[i] = 1.0F;
  }
  RenderOptions whole, thinned;
  whole.antialiased = thinned.antialiased = true;
  thinned.least_axis_px = 0.5F;
  const auto model = camera(96, 96);  // a Gaussian's axis takes 0.12 pixels
  const Picture all = draw(wall, model, {}, whole), some = draw(wall, model, {}, thinned);
  EXPECT_LT(some.stats.visible * 10, all.stats.visible);
  double squares = 0.0, difference = 0.0, covered = 0.0;
  for (std::size_t i = 0; i < all.colour.size(); ++i) {
    squares += std::pow(some.colour[i] - all.colour[i], 2);
    difference += some.colour[i] - all.colour[i];
    covered += all.colour[i];
  }
  const auto count = static_cast<double>(all.colour.size());
  EXPECT_GT(-10.0 * std::log10(squares / count), 30.0);
  EXPECT_LT(std::abs(difference), 0.08 * covered);  // at random some places are covered twice
}

TEST(Render, AnEmptyCloudGivesTheBackground) {
  RenderOptions options;
  options.background = {0.1F, 0.2F, 0.3F};
  gaussian::GaussianCloud empty;
  const Picture picture = draw(empty, camera(20, 10), {}, options);
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_EQ(picture.colour[3 * i + 1], 0.2F);
    EXPECT_EQ(picture.alpha[i], 0.0F);
    EXPECT_EQ(picture.depth_sum_m[i], 0.0F);
  }
}

TEST(Render, PixelCentresLieAtIntegerCoordinates) {
  geometry::CameraModel model = camera(15, 15);
  model.cx_px = model.cy_px = 7.0;
  const Picture picture = draw(one({0, 0, 2}, 0.3F, 2.0F), model, {});
  const auto alpha = [&picture](std::size_t x, std::size_t y) { return picture.alpha[15 * y + x]; };
  for (std::size_t d = 1; d <= 3; ++d) {
    EXPECT_NEAR(alpha(7 - d, 7), alpha(7 + d, 7), 4e-6);
    EXPECT_NEAR(alpha(7, 7 - d), alpha(7 + d, 7), 4e-6);
    EXPECT_LT(alpha(7 + d, 7), alpha(7, 7));
  }
  EXPECT_NEAR(alpha(7, 7), 1.0 / (1.0 + std::exp(-2.0)), 4e-6) << "at the centre alpha is the opacity";
}

TEST(Render, NearerGaussiansCoverFartherOnesWhateverTheirOrder) {
  auto near_white = one({0, 0, 1}, 0.5F, 10.0F);
  auto far_black = one({0, 0, 3}, 1.5F, 10.0F);
  for (float& value : far_black.sh) value = -5.0F;
  gaussian::GaussianCloud both = far_black;
  both.append_row(near_white, 0);
  const Picture picture = draw(both, camera(16, 16), {});
  const std::size_t middle = 8 * 16 + 7;
  EXPECT_GT(picture.colour[3 * middle], 0.7F);
  EXPECT_NEAR(picture.depth_sum_m[middle] / picture.alpha[middle], 1.0, 0.05);
}

TEST(Render, CountsAndSkipsWhatIsNotFinite) {
  test::Random random(1);
  auto cloud = test::random_cloud(random, {.count = 50, .sh_degree = 1});
  const Picture clean = draw(cloud, camera(32, 32), {});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const auto good = cloud;
  for (int i = 0; i < 5; ++i) cloud.append_row(good, 0);
  cloud.means_m[3 * 50] = nan;
  cloud.log_scales[3 * 51] = inf;
  cloud.quats_xyzw[4 * 52] = nan;
  cloud.opacity_logits[53] = -inf;
  cloud.sh[12 * 54 + 11] = nan;
  const Picture dirty = draw(cloud, camera(32, 32), {});
  EXPECT_EQ(dirty.stats.not_finite, 5U);
  EXPECT_EQ(dirty.colour, clean.colour);
}

TEST(Render, SurvivesExtremeButFiniteGaussians) {
  auto cloud = one({0, 0, 1}, 1.0F, 0.0F);
  const auto add = [&cloud](const gaussian::GaussianCloud& other) { cloud.append_row(other, 0); };
  auto extreme = one({0, 0, 2}, 1.0F, 80.0F);
  extreme.log_scales = {80.0F, -80.0F, 80.0F};
  add(extreme);
  extreme.log_scales = {-80.0F, -80.0F, -80.0F};
  add(extreme);
  extreme.quats_xyzw = {0, 0, 0, 0};
  add(extreme);
  add(one({1e30F, -1e30F, 1e30F}, 1.0F, 1.0F));
  add(one({0, 0, 0.0500001F}, 100.0F, 1.0F));
  const Picture picture = draw(cloud, camera(40, 30), {});
  for (const float value : picture.colour) ASSERT_TRUE(std::isfinite(value));
  for (const float value : picture.depth_sum_m) ASSERT_TRUE(std::isfinite(value));
  for (const float value : picture.alpha) ASSERT_TRUE(value >= 0.0F && value <= 1.0F);
}

TEST(Render, AGaussianLargerThanAnyIntegerCoversThePicture) {
  const Picture picture = draw(one({0, 0, 2}, 1e8F, 10.0F), camera(40, 30), {});
  for (const float alpha : picture.alpha) ASSERT_NEAR(alpha, 0.99, 1e-3);
}

TEST(Render, IsTheSameForEveryNumberOfThreads) {
  test::Random random(9);
  const auto cloud = test::random_cloud(random, {.count = 20000, .sh_degree = 1, .scale_max_m = 0.1});
  const auto with_threads = [&cloud](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return draw(cloud, camera(128, 96), {});
  };
  const Picture alone = with_threads(1);
  const Picture together = with_threads(4);
  EXPECT_EQ(alone.colour, together.colour);
  EXPECT_EQ(alone.depth_sum_m, together.depth_sum_m);
  EXPECT_EQ(alone.stats.tile_pairs, together.stats.tile_pairs);
}

TEST(Render, RefusesWrongLengths) {
  const auto cloud = one({0, 0, 1}, 1.0F, 0.0F);
  const View view = *View::from(camera(8, 8), {});
  std::vector<float> colour(3 * 64), depth(64), alpha(63);
  const auto short_output = render(core::Backend::kCpu, spans_of(cloud), view, {}, {colour, depth, alpha});
  ASSERT_FALSE(short_output);
  EXPECT_EQ(short_output.error().code, Errc::kInvalidArgument);
  alpha.resize(64);
  GaussianSpans wrong = spans_of(cloud);
  wrong.sh = wrong.sh.first(2);
  EXPECT_FALSE(render(core::Backend::kCpu, wrong, view, {}, {colour, depth, alpha}));
  wrong = spans_of(cloud);
  wrong.sh_degree = 4;
  EXPECT_FALSE(render(core::Backend::kCpu, wrong, view, {}, {colour, depth, alpha}));
}

}  // namespace
}  // namespace edgesplat::splat
