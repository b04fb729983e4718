// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/local_mapping/importance.hpp"

#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

namespace edgesplat::local_mapping {
namespace {

/// Four alike at 2, 2, 2 and 20 m.
gaussian::GaussianCloud four() {
  gaussian::GaussianCloud cloud;
  cloud.resize(4);
  for (std::size_t row = 0; row < 4; ++row) {
    cloud.means_m[3 * row] = row == 3 ? 20.0F : 2.0F;
    cloud.quats_xyzw[4 * row + 3] = 1.0F;
    for (std::size_t k = 0; k < 3; ++k) cloud.log_scales[3 * row + k] = -3.0F;
  }
  return cloud;
}

TEST(LeastImportant, FarOnesGoFirst) {
  EXPECT_EQ(least_important(four(), {0, 0, 0}, 1), std::vector<std::uint32_t>{3});
  EXPECT_NE(least_important(four(), {20, 0, 0}, 1), std::vector<std::uint32_t>{3});
}

TEST(LeastImportant, TransparentAndSmallOnesGoFirst) {
  auto cloud = four();
  cloud.means_m[9] = 2.0F;
  cloud.opacity_logits[1] = -8.0F;
  EXPECT_EQ(least_important(cloud, {0, 0, 0}, 1), std::vector<std::uint32_t>{1});
  cloud.opacity_logits[1] = 0.0F;
  for (std::size_t k = 0; k < 3; ++k) cloud.log_scales[6 + k] = -7.0F;
  EXPECT_EQ(least_important(cloud, {0, 0, 0}, 1), std::vector<std::uint32_t>{2});
}

TEST(LeastImportant, ADiscSeenFromTheFrontCountsByItsFace) {
  auto cloud = four();
  cloud.means_m[9] = 2.0F;
  cloud.log_scales[0] = -9.0F;  // thin, otherwise as large as the others
  cloud.log_scales[3] = -3.5F;  // smaller in its face
  cloud.log_scales[4] = -3.5F;
  EXPECT_EQ(least_important(cloud, {0, 0, 0}, 1), std::vector<std::uint32_t>{1});
}

TEST(LeastImportant, AnyCount) {
  const auto cloud = test::random_gaussians(100, 1);
  EXPECT_TRUE(least_important(cloud, {0, 0, 0}, 0).empty());
  EXPECT_EQ(least_important(cloud, {0, 0, 0}, 1000).size(), 100U);
  const auto rows = least_important(cloud, {0, 0, 0}, 30);
  EXPECT_EQ(rows.size(), 30U);
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
  EXPECT_TRUE(least_important({}, {0, 0, 0}, 3).empty());
}

}  // namespace
}  // namespace edgesplat::local_mapping
