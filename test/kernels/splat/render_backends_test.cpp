// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The same for every backend. Without a GPU, CUDA's half skips; test_kernels_splat_on_cpu runs its kernels
// there.
#include "kernels/splat/render.hpp"

#include "test/support/random_cloud.hpp"
#include "test/support/reference/splat_reference.hpp"

#include <gtest/gtest.h>

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

Picture blank(const View& view) {
  constexpr float kStale = 7.0F;  // outputs must be written whole
  const auto pixels = static_cast<std::size_t>(view.width_px * view.height_px);
  return {std::vector<float>(3 * pixels, kStale),
          std::vector<float>(pixels, kStale),
          std::vector<float>(pixels, kStale),
          {}};
}

class RenderOn : public testing::TestWithParam<core::Backend> {
 protected:
  void SetUp() override {
    const auto chosen = core::choose_backend(core::to_string(GetParam()));
    if (!chosen) GTEST_SKIP() << chosen.error().context;
  }
  [[nodiscard]] static Picture draw(const gaussian::GaussianCloud& cloud, const geometry::CameraModel& model,
                                    const geometry::RigidTransform& camera_from_map = {},
                                    const RenderOptions& options = {}) {
    const View view = *View::from(model, camera_from_map);
    Picture out = blank(view);
    const auto stats =
        render(GetParam(), spans_of(cloud), view, options, {out.colour, out.depth_sum_m, out.alpha});
    EXPECT_TRUE(stats) << stats.error().context;
    if (stats) out.stats = *stats;
    return out;
  }
};

/// Thresholds (1/255, 1e-4) may fall on the other side in single precision: such a pixel is off by at most
/// the weight of one splat there, 1/255 times its colour or depth. All others agree to rounding.
void expect_agrees(float drawn, double expected, double one_splat, double& sum) {
  ASSERT_LE(std::abs(drawn - expected), one_splat / 255.0 + 2e-4 * (1.0 + one_splat));
  sum += std::abs(drawn - expected);
}

void expect_agrees(const Picture& drawn, const test::ReferencePicture& expected) {
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
}

struct Case {
  std::uint64_t seed;
  std::size_t count;
  int sh_degree;
  int width_px, height_px;
  double scale_max_m;
};

TEST_P(RenderOn, EveryPixelAgreesWithTheReference) {
  for (const Case& c :
       {Case{1, 4, 0, 33, 17, 0.3}, Case{2, 300, 0, 64, 48, 0.3}, Case{3, 300, 1, 65, 47, 0.3},
        Case{4, 300, 2, 50, 50, 1.0}, Case{5, 300, 3, 64, 64, 0.05}, Case{6, 1500, 3, 72, 40, 2.0},
        Case{7, 40, 0, 1, 1, 2.0}}) {
    SCOPED_TRACE(c.seed);
    test::Random random(c.seed);
    const auto cloud = test::random_cloud(
        random, {.count = c.count, .sh_degree = c.sh_degree, .scale_max_m = c.scale_max_m});
    const geometry::RigidTransform pose{geometry::so3_exp(random.vector(0.3)), random.vector(0.5)};
    RenderOptions options;
    options.background = {0.2F, 0.4F, 0.9F};
    test::ReferenceOptions reference_options;
    reference_options.background = {0.2F, 0.4F, 0.9F};
    const auto model = camera(c.width_px, c.height_px);
    const Picture drawn = draw(cloud, model, pose, options);
    expect_agrees(drawn, test::reference_render(cloud, model, pose, reference_options));
    EXPECT_GT(drawn.stats.visible, 0U);
    EXPECT_GT(drawn.stats.tile_pairs, 0U);
  }
}

TEST_P(RenderOn, FisheyesAndAntialiasedSplatsAgreeWithTheReference) {
  for (const bool fisheye : {false, true}) {
    test::Random random(33);
    const auto cloud =
        test::random_cloud(random, {.count = 300, .sh_degree = 1, .scale_min_m = 0.002, .scale_max_m = 0.3});
    const geometry::RigidTransform pose{geometry::so3_exp(random.vector(0.3)), random.vector(0.5)};
    RenderOptions options;
    options.antialiased = true;
    test::ReferenceOptions reference_options;
    reference_options.antialiased = true;
    auto model = camera(64, 48);
    if (fisheye) model.kind = geometry::CameraKind::kFisheye;
    const Picture drawn = draw(cloud, model, pose, options);
    expect_agrees(drawn, test::reference_render(cloud, model, pose, reference_options));
    EXPECT_GT(drawn.stats.visible, 20U);
  }
}

TEST_P(RenderOn, ThinnedCloudsAgreeWithTheReference) {
  test::Random random(34);
  const auto cloud =
      test::random_cloud(random, {.count = 900, .sh_degree = 1, .scale_min_m = 0.01, .scale_max_m = 0.1});
  RenderOptions options;
  options.least_axis_px = 2.0F;
  test::ReferenceOptions reference_options;
  reference_options.least_axis_px = 2.0;
  const auto model = camera(64, 48);
  const Picture drawn = draw(cloud, model, {}, options);
  expect_agrees(drawn, test::reference_render(cloud, model, {}, reference_options));
  EXPECT_LT(drawn.stats.visible, draw(cloud, model, {}, {}).stats.visible * 3 / 4);
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

TEST_P(RenderOn, AnEmptyCloudAndOneBehindTheCameraGiveTheBackground) {
  RenderOptions options;
  options.background = {0.1F, 0.2F, 0.3F};
  for (const auto& cloud :
       {gaussian::GaussianCloud{}, one({0, 0, -2}, 1.0F, 5.0F), one({0, 0, 2}, 1.0F, -50.0F)}) {
    const Picture picture = draw(cloud, camera(20, 10), {}, options);
    EXPECT_EQ(picture.stats.visible, 0U);
    for (std::size_t i = 0; i < 200; ++i) {
      EXPECT_EQ(picture.colour[3 * i + 1], 0.2F);
      EXPECT_EQ(picture.alpha[i], 0.0F);
      EXPECT_EQ(picture.depth_sum_m[i], 0.0F);
    }
  }
}

TEST_P(RenderOn, NeedlesAndGiantsAgreeWithTheReference) {
  test::Random random(31);
  auto cloud = test::random_cloud(random, {.count = 60, .scale_max_m = 0.2});
  for (std::size_t i = 0; i < 20; ++i) cloud.log_scales[3 * i + i % 3] = 2.0F;
  for (std::size_t i = 20; i < 40; ++i) cloud.log_scales[3 * i] = cloud.log_scales[3 * i + 1] = -12.0F;
  for (std::size_t i = 40; i < 44; ++i)
    for (std::size_t k = 0; k < 3; ++k) cloud.log_scales[3 * i + k] = 3.0F;
  for (std::size_t i = 44; i < 52; ++i) cloud.opacity_logits[i] = 40.0F;
  const auto model = camera(96, 64);
  const Picture drawn = draw(cloud, model);
  expect_agrees(drawn, test::reference_render(cloud, model, {}, {}));
}

TEST_P(RenderOn, AGaussianOnEveryTileCoversThePicture) {
  const Picture picture = draw(one({0, 0, 2}, 1e8F, 10.0F), camera(100, 70));
  // Tiles of 32x16 pixels on the CPU, 16x16 on a GPU.
  EXPECT_EQ(picture.stats.tile_pairs, GetParam() == core::Backend::kCpu ? 4U * 5U : 7U * 5U);
  for (const float alpha : picture.alpha) ASSERT_NEAR(alpha, 0.99, 1e-3);
}

TEST_P(RenderOn, ExtremeButFiniteGaussiansGiveFinitePictures) {
  auto cloud = one({0, 0, 1}, 1.0F, 0.0F);
  const auto add = [&cloud](const gaussian::GaussianCloud& other) { cloud.append_row(other, 0); };
  auto extreme = one({0, 0, 2}, 1.0F, 80.0F);
  for (const auto& scales : {std::vector{80.0F, -80.0F, 80.0F}, std::vector{-80.0F, -80.0F, -80.0F},
                             std::vector{30.0F, 30.0F, 30.0F}, std::vector{23.0F, -80.0F, -80.0F}}) {
    extreme.log_scales = scales;
    add(extreme);
  }
  extreme.quats_xyzw = {0, 0, 0, 0};
  add(extreme);
  add(one({1e30F, -1e30F, 1e30F}, 1.0F, 1.0F));
  add(one({0, 0, 0.0500001F}, 100.0F, 1.0F));
  const Picture picture = draw(cloud, camera(40, 30));
  for (const float value : picture.colour) ASSERT_TRUE(std::isfinite(value));
  for (const float value : picture.depth_sum_m) ASSERT_TRUE(std::isfinite(value));
  for (const float value : picture.alpha) ASSERT_TRUE(value >= 0.0F && value <= 1.0F);
}

TEST_P(RenderOn, CountsAndSkipsWhatIsNotFinite) {
  test::Random random(1);
  auto cloud = test::random_cloud(random, {.count = 50, .sh_degree = 1});
  const Picture clean = draw(cloud, camera(32, 32));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const auto good = cloud;
  for (int i = 0; i < 5; ++i) cloud.append_row(good, 0);
  cloud.means_m[3 * 50] = nan;
  cloud.log_scales[3 * 51] = inf;
  cloud.quats_xyzw[4 * 52] = nan;
  cloud.opacity_logits[53] = -inf;
  cloud.sh[12 * 54 + 11] = nan;
  const Picture dirty = draw(cloud, camera(32, 32));
  EXPECT_EQ(dirty.stats.not_finite, 5U);
  EXPECT_EQ(dirty.colour, clean.colour);
}

TEST_P(RenderOn, EqualDepthsAreDrawnInTheOrderOfRows) {
  auto red = one({0, 0, 2}, 0.5F, 10.0F), green = red;
  red.sh = {5.0F, -5.0F, -5.0F};
  green.sh = {-5.0F, 5.0F, -5.0F};
  gaussian::GaussianCloud both = red;
  for (int i = 0; i < 300; ++i) both.append_row(green, 0);
  const Picture picture = draw(both, camera(16, 16));
  const std::size_t middle = 8 * 16 + 7;
  EXPECT_GT(picture.colour[3 * middle], 1.0F);
  EXPECT_LT(picture.colour[3 * middle + 1], 0.1F);
}

TEST_P(RenderOn, TheSameRendererDrawsOtherViewsAndClouds) {
  auto renderer = Renderer::create(GetParam());
  ASSERT_TRUE(renderer) << renderer.error().context;
  test::Random random(5);
  for (const std::size_t count : {2000U, 3U, 0U, 500U}) {
    const auto cloud = test::random_cloud(random, {.count = count, .sh_degree = count == 3U ? 2 : 0});
    ASSERT_TRUE(renderer->set_cloud(spans_of(cloud)));
    for (const int width_px : {20, 90, 33}) {
      const geometry::RigidTransform pose{geometry::so3_exp(random.vector(0.3)), random.vector(0.5)};
      const View view = *View::from(camera(width_px, 40), pose);
      Picture again = blank(view);
      const auto stats = renderer->draw(view, {}, {again.colour, again.depth_sum_m, again.alpha});
      ASSERT_TRUE(stats) << stats.error().context;
      const Picture alone = draw(cloud, camera(width_px, 40), pose);
      EXPECT_EQ(again.colour, alone.colour);
      EXPECT_EQ(again.alpha, alone.alpha);
      EXPECT_EQ(stats->tile_pairs, alone.stats.tile_pairs);
    }
  }
}

TEST_P(RenderOn, RefusesWrongLengths) {
  const auto cloud = one({0, 0, 1}, 1.0F, 0.0F);
  const View view = *View::from(camera(8, 8), {});
  std::vector<float> colour(3 * 64), depth(64), alpha(63);
  const auto short_output = render(GetParam(), spans_of(cloud), view, {}, {colour, depth, alpha});
  ASSERT_FALSE(short_output);
  EXPECT_EQ(short_output.error().code, Errc::kInvalidArgument);
  alpha.resize(64);
  GaussianSpans wrong = spans_of(cloud);
  wrong.sh = wrong.sh.first(2);
  EXPECT_FALSE(render(GetParam(), wrong, view, {}, {colour, depth, alpha}));
  wrong = spans_of(cloud);
  wrong.sh_degree = 4;
  EXPECT_FALSE(render(GetParam(), wrong, view, {}, {colour, depth, alpha}));
}

INSTANTIATE_TEST_SUITE_P(Backends, RenderOn, testing::Values(core::Backend::kCpu, core::Backend::kCuda),
                         [](const auto& backend) { return std::string(core::to_string(backend.param)); });

}  // namespace
}  // namespace edgesplat::splat
