// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/quantised.hpp"

#include "test/support/map_samples.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgesplat::map {
namespace {

double angle_between(const float* a, const float* b) {
  double dot = 0.0;
  for (int k = 0; k < 4; ++k) dot += static_cast<double>(a[k]) * static_cast<double>(b[k]);
  return 2.0 * std::acos(std::min(1.0, std::abs(dot)));
}

TEST(Quantised, EveryFieldComesBackWithinHalfAStep) {
  const auto cloud = test::random_gaussians(3000, 1, 3);
  QuantisedRows rows;
  rows.sh_degree = 3;
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    const float* m = cloud.means_m.data() + 3 * row;
    append_quantised(cloud, row, chunk_of({m[0], m[1], m[2]}), rows);
  }
  ASSERT_TRUE(rows.consistent());
  const auto back = dequantise(rows);
  ASSERT_TRUE(back.consistent());
  EXPECT_EQ(back.ids, cloud.ids);
  EXPECT_EQ(back.anchors, cloud.anchors);
  for (std::size_t i = 0; i < cloud.means_m.size(); ++i) {
    EXPECT_NEAR(back.means_m[i], cloud.means_m[i], 0.0000925);  // 12 m / 65536 / 2, and float
    EXPECT_NEAR(back.log_scales[i], cloud.log_scales[i], 1.0 / 32 + 1e-6);
  }
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    EXPECT_LT(angle_between(&back.quats_xyzw[4 * row], &cloud.quats_xyzw[4 * row]),
              0.0085);  // half a step of 2.8e-3 in each of four components, twice
    const auto alpha = [](float logit) { return 1.0 / (1.0 + std::exp(-static_cast<double>(logit))); };
    EXPECT_NEAR(alpha(back.opacity_logits[row]), alpha(cloud.opacity_logits[row]), 1.0 / 512 + 1e-6);
    for (std::size_t k = 0; k < 48; ++k) {
      const double step = k < 3 ? 1.0 / 256 / 0.2820948 : 1.0 / 64;
      EXPECT_NEAR(back.sh[48 * row + k], cloud.sh[48 * row + k], step / 2 + 1e-5) << k;
    }
  }
}

// Repeated corrections must not make a Gaussian drift by itself.
TEST(Quantised, APoseDecodedAndEncodedAgainIsTheSamePose) {
  test::Random random(3);
  for (int i = 0; i < 20000; ++i) {
    const ChunkId chunk{static_cast<std::int32_t>(random.below(2000)) - 1000, -100000, 7};
    Channels channels{};
    for (std::size_t k = 0; k < 3; ++k) channels[k] = static_cast<std::uint16_t>(random.below(65536));
    encode_pose(chunk, {decode_pose(chunk, channels).mean_m, {random.uniform(-1, 1), 0.3, -0.2, 0.5}},
                channels);
    Channels again = channels;
    encode_pose(chunk, decode_pose(chunk, channels), again);
    ASSERT_TRUE(std::equal(again.begin(), again.begin() + 3, channels.begin()));
    // Where two components are the largest alike, the other one may be left out the second time.
    ASSERT_TRUE(again[kLargestAt] != channels[kLargestAt] || again == channels);
    const auto p = decode_pose(chunk, channels).quat_xyzw;
    const auto q = decode_pose(chunk, again).quat_xyzw;
    ASSERT_GT(std::abs(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3]), 1.0 - 1e-5);
  }
}

TEST(Quantised, AnyIntegersAreAValidGaussian) {
  test::Random random(4);
  QuantisedRows rows;
  rows.sh_degree = 1;
  rows.resize(5000);
  for (auto& channels : rows.channels) {
    for (const ChannelLayout& layout : kChannelLayouts) {
      for (std::size_t k = layout.first; k < layout.first + layout.count; ++k) {
        const std::size_t choice = random.below(4);
        const std::uint32_t most = (1U << layout.bits) - 1;
        channels[k] = static_cast<std::uint16_t>(choice == 0   ? 0
                                                 : choice == 1 ? most
                                                               : random.below(most + 1));
      }
    }
  }
  const auto cloud = dequantise(rows);
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    EXPECT_EQ(unquantisable(cloud, row), nullptr);
    double norm2 = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
      norm2 += std::pow(static_cast<double>(cloud.quats_xyzw[4 * row + k]), 2);
    EXPECT_NEAR(norm2, 1.0, 1e-5);
  }
}

TEST(Quantised, ExtremesAreClampedNotWrapped) {
  auto cloud = test::random_gaussians(1, 1);
  cloud.means_m = {9.9999F, -0.9F, 10.99F};
  cloud.log_scales = {-30.0F, 30.0F, 0.0F};
  cloud.opacity_logits = {80.0F};
  cloud.sh = {100.0F, -100.0F, 0.0F};
  QuantisedRows rows;
  append_quantised(cloud, 0, ChunkId{}, rows);
  const auto back = dequantise(rows);
  EXPECT_NEAR(back.means_m[1], -0.9F, 1e-4);
  EXPECT_NEAR(back.means_m[2], 10.99F, 1e-4);
  EXPECT_FLOAT_EQ(back.log_scales[0], -10.0F);
  EXPECT_NEAR(back.log_scales[1], 5.9375F, 1e-3);
  EXPECT_GT(back.opacity_logits[0], 6.0F);
  EXPECT_NEAR(0.5 + 0.2820948 * static_cast<double>(back.sh[0]), 1.496, 1e-3);
  EXPECT_NEAR(0.5 + 0.2820948 * static_cast<double>(back.sh[1]), -0.5, 1e-3);
}

TEST(Quantised, SaysWhatCannotBeQuantised) {
  const auto flawed = [](auto change) {
    auto cloud = test::random_gaussians(3, 1, 1);
    change(cloud);
    EXPECT_EQ(unquantisable(cloud, 0), nullptr);
    return unquantisable(cloud, 1) != nullptr;
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(flawed([](auto&) {}));
  EXPECT_TRUE(flawed([](auto& c) { c.means_m[4] = kNan; }));
  EXPECT_TRUE(flawed([](auto& c) { c.means_m[4] = 2e6F; }));
  EXPECT_TRUE(flawed([](auto& c) { c.log_scales[3] = kInfinite; }));
  EXPECT_TRUE(flawed([](auto& c) { c.opacity_logits[1] = kNan; }));
  EXPECT_TRUE(flawed([](auto& c) { c.sh[12] = kNan; }));
  EXPECT_TRUE(flawed([](auto& c) {
    for (std::size_t k = 4; k < 8; ++k) c.quats_xyzw[k] = 0.0F;
  }));
}

}  // namespace
}  // namespace edgesplat::map
