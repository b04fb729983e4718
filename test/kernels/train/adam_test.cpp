// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/adam.hpp"

#include "test/support/random_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace edgesplat::train {
namespace {

/// Rows of one value each.
struct Gradients {
  std::size_t stride;
  std::vector<std::uint32_t> rows;
  std::vector<float> values;
};
Gradients gradients_for(const gaussian::GaussianCloud& cloud, std::vector<std::uint32_t> rows, float value) {
  Gradients out;
  out.stride = ParameterRow::stride(cloud.sh_degree);
  out.values.resize(rows.size() * out.stride);
  for (std::size_t i = 0; i < rows.size(); ++i)
    std::fill_n(&out.values[i * out.stride], ParameterRow::size(cloud.sh_degree), value);
  out.rows = std::move(rows);
  return out;
}

void step(Adam& adam, const Gradients& gradients, const LearningRates& rates,
          gaussian::GaussianCloud& cloud) {
  adam.step(gradients.rows, gradients.values, rates, cloud);
}

TEST(Adam, FollowsTheFormula) {
  test::Random random(1);
  auto cloud = test::random_cloud(random, {.count = 3, .sh_degree = 1});
  Adam adam(1, {.mean_final_share = 1.0F});
  adam.resize(3);
  const LearningRates rates{.mean_m = 0.01F,
                            .log_scale = 0.02F,
                            .quat = 0.0F,
                            .opacity_logit = 0.03F,
                            .sh_base = 0.04F,
                            .sh_rest = 0.05F};
  double m = 0.0, v = 0.0, moved = 0.0;
  const auto before = cloud;
  for (int t = 1; t <= 20; ++t) {
    const double g = 0.3 * std::sin(t);
    step(adam, gradients_for(cloud, {1}, static_cast<float>(g)), rates, cloud);
    m = 0.9 * m + 0.1 * g;
    v = 0.999 * v + 0.001 * g * g;
    moved += m / (1.0 - std::pow(0.9, t)) / (std::sqrt(v / (1.0 - std::pow(0.999, t))) + 1e-15);
  }
  const auto expect_moved = [moved](float now, float then, double rate) {
    EXPECT_NEAR(static_cast<double>(now - then), -rate * moved, 1e-5);
  };
  expect_moved(cloud.means_m[3], before.means_m[3], 0.01);
  expect_moved(cloud.log_scales[5], before.log_scales[5], 0.02);
  expect_moved(cloud.opacity_logits[1], before.opacity_logits[1], 0.03);
  expect_moved(cloud.sh[12 + 2], before.sh[12 + 2], 0.04);
  expect_moved(cloud.sh[12 + 3], before.sh[12 + 3], 0.05);
  EXPECT_EQ(adam.steps_of(1), 20U);
  EXPECT_EQ(adam.steps_of(0), 0U);
  EXPECT_EQ(cloud.means_m[0], before.means_m[0]) << "a row that the picture does not show stays";
}

TEST(Adam, ARowsFirstStepIsItsRateWheneverItComes) {
  test::Random random(2);
  auto cloud = test::random_cloud(random, {.count = 2});
  Adam adam(0, {});
  adam.resize(2);
  const LearningRates rates{.mean_m = 0.01F};
  for (int t = 0; t < 500; ++t) step(adam, gradients_for(cloud, {0}, 1.0F), rates, cloud);
  const float before = cloud.means_m[3];
  step(adam, gradients_for(cloud, {1}, 1e-4F), rates, cloud);
  EXPECT_NEAR(cloud.means_m[3] - before, -0.01F, 1e-6F);
}

TEST(Adam, AMeansRateFallsWithTheStepsOfItsGaussian) {
  test::Random random(6);
  auto cloud = test::random_cloud(random, {.count = 1});
  Adam adam(0, {.mean_final_share = 0.1F, .mean_decay_steps = 10.0F});
  adam.resize(1);
  float before = 0.0F;
  for (int t = 0; t < 101; ++t) {
    before = cloud.means_m[0];
    step(adam, gradients_for(cloud, {0}, 1.0F), {.mean_m = 0.01F}, cloud);
  }
  EXPECT_NEAR(before - cloud.means_m[0], 0.001F, 1e-5F);
}

TEST(Adam, KeepsQuaternionsOfUnitLength) {
  test::Random random(3);
  auto cloud = test::random_cloud(random, {.count = 1});
  Adam adam(0, {});
  adam.resize(1);
  for (int t = 0; t < 50; ++t) step(adam, gradients_for(cloud, {0}, 1.0F), {.quat = 0.1F}, cloud);
  double norm2 = 0.0;
  for (const float q : cloud.quats_xyzw) norm2 += static_cast<double>(q * q);
  EXPECT_NEAR(norm2, 1.0, 1e-5);
}

TEST(Adam, MomentsFollowTheirRows) {
  test::Random random(4);
  auto cloud = test::random_cloud(random, {.count = 3});
  Adam adam(0, {});
  adam.resize(3);
  for (int t = 0; t < 5; ++t) step(adam, gradients_for(cloud, {2}, 1.0F), {}, cloud);
  const std::vector<std::uint32_t> kept{0, 2};
  adam.keep_rows(kept);
  adam.resize(3);
  EXPECT_EQ(adam.steps_of(1), 5U);
  EXPECT_EQ(adam.steps_of(2), 0U);
  adam.reset_row(1);
  EXPECT_EQ(adam.steps_of(1), 0U);
}

TEST(Adam, LeavesARowWhoseResultIsNotFinite) {
  test::Random random(5);
  auto cloud = test::random_cloud(random, {.count = 1});
  Adam adam(0, {});
  adam.resize(1);
  const auto before = cloud;
  step(adam, gradients_for(cloud, {0}, std::numeric_limits<float>::quiet_NaN()), {}, cloud);
  EXPECT_EQ(cloud.means_m, before.means_m);
  EXPECT_EQ(cloud.quats_xyzw, before.quats_xyzw);
}

}  // namespace
}  // namespace edgesplat::train
