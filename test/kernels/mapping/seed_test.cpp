// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/seed.hpp"

#include "test/support/map_samples.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace edgesplat::mapping {
namespace {

SeedInput input_of(const map::Keyframe& keyframe) {
  SeedInput input;
  input.points_in_body = keyframe.points_in_body;
  input.map_from_body = keyframe.odom_from_body;
  input.anchor = {keyframe.id.value, keyframe.pose_version};
  input.has_camera = keyframe.camera.has_value();
  return input;
}

class SeedTest : public ::testing::Test {
 protected:
  IdAllocator ids_{7, 100};
  SeedOptions options_;
  MapSeeder seeder_{options_, ids_};
};

TEST_F(SeedTest, NoPointsNoGaussians) {
  const auto cloud = seeder_.seed({});
  EXPECT_EQ(cloud.size(), 0U);
  EXPECT_TRUE(cloud.consistent());
}

TEST_F(SeedTest, OnePointBecomesOneRoundGaussianOfItsColour) {
  map::ColouredPoint point;
  point.p_in_body_m = {2.0F, 0.0F, 0.0F};
  point.rgb = {255, 0, 128};
  point.has_colour = true;
  SeedInput input;
  input.points_in_body = std::span(&point, 1);
  input.map_from_body.translation_m = {10.0, 20.0, 30.0};
  input.anchor = {9, 1};
  const auto cloud = seeder_.seed(input);
  ASSERT_EQ(cloud.size(), 1U);
  ASSERT_TRUE(cloud.consistent());
  EXPECT_EQ(cloud.ids[0], gaussian::GaussianId(7, 100));
  EXPECT_EQ(cloud.anchors[0], (gaussian::Anchor{9, 1}));
  EXPECT_FLOAT_EQ(cloud.means_m[0], 12.0F);
  EXPECT_FLOAT_EQ(cloud.means_m[2], 30.0F);
  EXPECT_NEAR(0.5 + gaussian::GaussianCloud::kShC0 * cloud.sh[0], 1.0, 1e-6);
  EXPECT_NEAR(0.5 + gaussian::GaussianCloud::kShC0 * cloud.sh[1], 0.0, 1e-6);
  EXPECT_NEAR(1.0 / (1.0 + std::exp(-cloud.opacity_logits[0])), 0.9, 1e-6);
  EXPECT_FLOAT_EQ(cloud.log_scales[0], cloud.log_scales[2]);
}

TEST_F(SeedTest, AWallIsCoveredByFlatGaussiansThatFaceIt) {
  const auto keyframe = test::wall_keyframe(1, 20000);
  const auto cloud = seeder_.seed(input_of(keyframe));
  // 4 m x 2 m in cells of 6 cm.
  const double cells = (4.0 / 0.06) * (2.0 / 0.06);
  EXPECT_GT(static_cast<double>(cloud.size()), 0.9 * cells);
  EXPECT_LT(static_cast<double>(cloud.size()), 1.2 * cells);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Quaternionf q(cloud.quats_xyzw[4 * i + 3], cloud.quats_xyzw[4 * i],
                               cloud.quats_xyzw[4 * i + 1], cloud.quats_xyzw[4 * i + 2]);
    EXPECT_NEAR(q.norm(), 1.0F, 1e-4F);
    const Eigen::Vector3f thin = q * Eigen::Vector3f::UnitZ();
    EXPECT_GT(std::abs(thin.x()), 0.99F) << i;  // the wall's normal
    EXPECT_LT(cloud.log_scales[3 * i + 2], cloud.log_scales[3 * i] - 1.0F);
    EXPECT_NEAR(cloud.means_m[3 * i], 3.0F, 1e-3F);
    const float sigma_m = std::exp(cloud.log_scales[3 * i]);
    EXPECT_GT(sigma_m, 0.02F);
    EXPECT_LT(sigma_m, 0.08F);
  }
}

TEST_F(SeedTest, TheSameViewTwiceAddsNextToNothing) {
  const auto first = seeder_.seed(input_of(test::wall_keyframe(1, 20000)));
  const auto again = seeder_.seed(input_of(test::wall_keyframe(2, 20000)));
  EXPECT_LT(again.size(), first.size() / 50);
  const auto beside = seeder_.seed(input_of(test::wall_keyframe(3, 20000, 2.0)));  // half of it is new
  EXPECT_GT(beside.size(), first.size() * 4 / 10);
  EXPECT_LT(beside.size(), first.size() * 6 / 10);
}

TEST_F(SeedTest, FarSurfacesGetFewerAndLargerGaussians) {
  auto near = test::wall_keyframe(1, 20000);
  auto far = near;
  for (auto& point : far.points_in_body) point.p_in_body_m.x() = 40.0F;
  const auto near_cloud = seeder_.seed(input_of(near));
  const auto far_cloud = seeder_.seed(input_of(far));
  EXPECT_LT(far_cloud.size() * 4, near_cloud.size());
  EXPECT_GT(far_cloud.log_scales[0], near_cloud.log_scales[0] + 0.5F);
  // Walking up to it, the finer grid is filled.
  far.odom_from_body.translation_m.x() = 37.0;
  for (auto& point : far.points_in_body) point.p_in_body_m.x() = 3.0F;
  EXPECT_GT(seeder_.seed(input_of(far)).size(), near_cloud.size() / 2);
}

TEST_F(SeedTest, PointsOfPixelsAreAsWideAsTheirPixelsHoweverFarAway) {
  map::ColouredPoint points[2];
  points[0].p_in_body_m = {20.0F, 0.0F, 0.0F};
  points[1].p_in_body_m = {0.0F, 100.0F, 0.0F};  // beyond what is measured
  for (auto& point : points) point.has_colour = true;
  SeedInput input;
  input.points_in_body = points;
  input.map_from_body.translation_m = {10.0, 20.0, 30.0};
  input.spacing_rad = 0.01F;
  const auto cloud = seeder_.seed(input);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_NEAR(std::exp(cloud.log_scales[0]), options_.sigma_per_spacing * 0.2F, 1e-4F);
  EXPECT_NEAR(std::exp(cloud.log_scales[3]), options_.sigma_per_spacing * 1.0F, 1e-4F);
  EXPECT_EQ(seeder_.stats().out_of_range, 0U);
}

TEST_F(SeedTest, UncolouredPointsWaitForTheirColour) {
  auto keyframe = test::wall_keyframe(1, 5000);
  for (auto& point : keyframe.points_in_body) point.has_colour = false;
  EXPECT_EQ(seeder_.seed(input_of(keyframe)).size(), 0U);
  EXPECT_EQ(seeder_.stats().uncoloured, 5000U);
  for (auto& point : keyframe.points_in_body) point.has_colour = true;
  EXPECT_GT(seeder_.seed(input_of(keyframe)).size(), 0U);
}

TEST_F(SeedTest, WithoutACameraPointsAreGrey) {
  auto keyframe = test::wall_keyframe(1, 100);
  keyframe.camera.reset();
  for (auto& point : keyframe.points_in_body) point.has_colour = false;
  const auto cloud = seeder_.seed(input_of(keyframe));
  ASSERT_GT(cloud.size(), 0U);
  EXPECT_EQ(cloud.sh[0], 0.0F);
}

TEST_F(SeedTest, PointsThatAreNoPlacesAreLeftOutAndCounted) {
  auto keyframe = test::wall_keyframe(1, 10);
  keyframe.points_in_body[0].p_in_body_m.x() = std::numeric_limits<float>::quiet_NaN();
  keyframe.points_in_body[1].p_in_body_m.y() = std::numeric_limits<float>::infinity();
  keyframe.points_in_body[2].p_in_body_m.z() = 500.0F;
  const auto cloud = seeder_.seed(input_of(keyframe));
  EXPECT_EQ(seeder_.stats().out_of_range, 3U);
  EXPECT_LE(cloud.size(), 7U);
  for (const float v : cloud.means_m) EXPECT_TRUE(std::isfinite(v));
}

TEST_F(SeedTest, EqualCallsGiveEqualGaussians) {
  IdAllocator other_ids(7, 100);
  MapSeeder other(options_, other_ids);
  for (std::uint32_t id = 1; id < 5; ++id) {
    const auto keyframe = test::random_keyframe(id, 2000, id);
    const auto a = seeder_.seed(input_of(keyframe));
    const auto b = other.seed(input_of(keyframe));
    EXPECT_EQ(a.ids, b.ids);
    EXPECT_EQ(a.means_m, b.means_m);
    EXPECT_EQ(a.log_scales, b.log_scales);
    EXPECT_EQ(a.quats_xyzw, b.quats_xyzw);
    EXPECT_EQ(a.sh, b.sh);
  }
}

TEST_F(SeedTest, EveryPointIsInOneCounter) {
  (void)seeder_.seed(input_of(test::wall_keyframe(1, 3000)));
  (void)seeder_.seed(input_of(test::random_keyframe(2, 3000, 5)));
  const SeedStats& stats = seeder_.stats();
  EXPECT_EQ(stats.points, 6000U);
  EXPECT_LE(stats.seeded + stats.covered + stats.uncoloured + stats.out_of_range, stats.points);
  EXPECT_GT(stats.seeded, 0U);
}

}  // namespace
}  // namespace edgesplat::mapping
