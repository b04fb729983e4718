// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/repose.hpp"

#include "common/map/map_state.hpp"
#include "kernels/splat/sh_math.hpp"
#include "test/common/map/delta_samples.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

namespace edgesplat::map {
namespace {

geometry::RigidTransform turned(double yaw_rad, const Eigen::Vector3d& translation_m) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())), translation_m};
}

/// One colour of a Gaussian seen along a direction.
double seen_colour(const gaussian::GaussianCloud& cloud, std::size_t row, std::size_t colour,
                   const Eigen::Vector3d& along) {
  std::array<double, 16> basis{};
  splat::sh_basis(cloud.sh_degree, along.x(), along.y(), along.z(), basis.data());
  const float* sh = cloud.sh.data() + cloud.sh_floats_each() * row + colour;
  double sum = 0.0;
  for (std::size_t i = 0; 3 * i < cloud.sh_floats_each(); ++i) sum += basis[i] * sh[3 * i];
  return sum;
}

TEST(Repose, MovesByNewTimesOldInverse) {
  auto cloud = test::random_gaussians(200, 1);
  for (std::size_t row = 0; row < 200; ++row) cloud.anchors[row] = {static_cast<std::uint32_t>(row % 2), 0};
  const auto before = cloud;
  const PoseCorrection correction{1, 1, turned(0.3, {4, 5, 6}), turned(0.35, {4.2, 5.1, 6})};
  const Repose repose(std::span(&correction, 1));
  const auto motion = correction.new_map_from_body * correction.old_map_from_body.inverse();
  for (std::size_t row = 0; row < 200; ++row) {
    EXPECT_EQ(repose.move(cloud, row), row % 2 == 1);
    const Eigen::Map<const Eigen::Vector3f> was(&before.means_m[3 * row]);
    const Eigen::Map<const Eigen::Vector3f> is(&cloud.means_m[3 * row]);
    const Eigen::Vector3d expected = row % 2 == 1 ? motion * was.cast<double>() : was.cast<double>().eval();
    EXPECT_LT((is.cast<double>() - expected).norm(), 1e-4);
    const Eigen::Map<const Eigen::Quaternionf> q_was(&before.quats_xyzw[4 * row]);
    const Eigen::Map<const Eigen::Quaternionf> q_is(&cloud.quats_xyzw[4 * row]);
    const Eigen::Quaterniond q_expected =
        row % 2 == 1 ? motion.rotation * q_was.cast<double>() : q_was.cast<double>();
    EXPECT_LT(q_is.cast<double>().angularDistance(q_expected), 1e-3);
    EXPECT_EQ(cloud.anchors[row].pose_version, row % 2);
  }
}

TEST(Repose, QuantisedGaussiansMoveLikeFloatsWithinAStep) {
  auto cloud = test::random_gaussians(500, 2);
  auto rows = test::quantised(cloud);
  cloud = dequantise(rows);
  const PoseCorrection correction{3, 1, turned(-1.0, {40, -5, 1}), turned(-0.8, {41, -4, 1})};
  const Repose repose(std::span(&correction, 1));
  for (std::size_t row = 0; row < 500; ++row) {
    ASSERT_TRUE(repose.move(cloud, row));
    ASSERT_TRUE(repose.move(rows, row));
  }
  const auto moved = dequantise(rows);
  for (std::size_t i = 0; i < moved.means_m.size(); ++i)
    EXPECT_NEAR(moved.means_m[i], cloud.means_m[i], 2e-4);
  for (std::size_t row = 0; row < 500; ++row) {
    const float* m = &moved.means_m[3 * row];
    // Within the chunk it has now, or its slack.
    EXPECT_EQ(chunk_after_move(rows.chunks[row], {m[0], m[1], m[2]}), rows.chunks[row]);
  }
}

TEST(Repose, HappensExactlyOnceForEachVersion) {
  MapState state;
  ASSERT_TRUE(state.apply({test::sample_header(), AddBody{test::random_rows(100, 1)}}).has_value());
  const ReposeBody first{{{3, 1, turned(0, {0, 0, 0}), turned(0, {0.5, 0, 0})}}};
  ASSERT_TRUE(state.apply({test::sample_header(), first}).has_value());
  const std::uint64_t once = state.hash();
  ASSERT_TRUE(state.apply({test::sample_header(), first}).has_value());
  EXPECT_EQ(state.hash(), once);
  const ReposeBody older{{{3, 0, turned(0, {0, 0, 0}), turned(0, {9, 0, 0})}}};
  ASSERT_TRUE(state.apply({test::sample_header(), older}).has_value());
  EXPECT_EQ(state.hash(), once);
  const ReposeBody second{{{3, 2, turned(0, {0.5, 0, 0}), turned(0, {0.75, 0, 0})}}};
  ASSERT_TRUE(state.apply({test::sample_header(), second}).has_value());
  EXPECT_NE(state.hash(), once);
}

// Seen from where it was seen before, relative to it, a Gaussian that turned must look as before.
TEST(Repose, TheColoursOfAllDirectionsTurnAlong) {
  for (int degree = 1; degree <= 3; ++degree) {
    auto rows = test::random_rows(100, 7, degree);
    auto cloud = dequantise(rows);
    const auto before = cloud;
    const PoseCorrection correction{3, 1, turned(0.4, {1, 2, 0}), turned(2.0, {3, 1, 1})};
    const Repose repose(std::span(&correction, 1));
    const auto turn = (correction.new_map_from_body * correction.old_map_from_body.inverse()).rotation;
    const Eigen::Vector3d seen_along = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
    for (std::size_t row = 0; row < 100; ++row) {
      ASSERT_TRUE(repose.move(cloud, row));
      ASSERT_TRUE(repose.move(rows, row));
    }
    const auto integers = dequantise(rows);
    for (std::size_t row = 0; row < 100; ++row) {
      for (std::size_t colour = 0; colour < 3; ++colour) {
        const double was = seen_colour(before, row, colour, seen_along);
        EXPECT_NEAR(seen_colour(cloud, row, colour, turn * seen_along), was, 1e-5);
        EXPECT_NEAR(seen_colour(integers, row, colour, turn * seen_along), was, 0.05);
      }
    }
  }
}

// Quantisation must not add up over many corrections.
TEST(Repose, ThereAndBackManyTimesEndsWhereItBegan) {
  const auto rows = test::random_rows(300, 5);
  MapState state;
  ASSERT_TRUE(state.apply({test::sample_header(), AddBody{rows}}).has_value());
  const auto here = turned(0.2, {1, 2, 3});
  const auto there = turned(0.21, {1.3, 2.1, 3});
  for (std::uint32_t i = 0; i < 20; ++i) {
    const bool out = i % 2 == 0;
    const ReposeBody body{{{3, i + 1, out ? here : there, out ? there : here}}};
    ASSERT_TRUE(state.apply({test::sample_header(), body}).has_value());
  }
  const auto before = dequantise(rows);
  const auto after = dequantise(state.rows());
  for (std::size_t i = 0; i < before.means_m.size(); ++i)
    EXPECT_NEAR(after.means_m[i], before.means_m[i],
                2.5e-3);  // a random walk of half steps of position and turn
}

TEST(Repose, ACorrectionOutOfThisWorldMovesNothingButCounts) {
  auto rows = test::random_rows(10, 1);
  const auto before = rows.channels;
  const PoseCorrection correction{3, 1, turned(0, {-1e6, 0, 0}), turned(0, {1e6, 0, 0})};
  const Repose repose(std::span(&correction, 1));
  for (std::size_t row = 0; row < 10; ++row) {
    EXPECT_TRUE(repose.move(rows, row));
    EXPECT_EQ(rows.anchors[row].pose_version, 1U);
  }
  EXPECT_EQ(rows.channels, before);
}

}  // namespace
}  // namespace edgesplat::map
