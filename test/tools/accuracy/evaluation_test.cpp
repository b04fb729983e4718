// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/accuracy/evaluation.hpp"

#include "common/geometry/so3.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace edgesplat::accuracy {
namespace {

using geometry::RigidTransform;

RigidTransform transform(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m) {
  return {geometry::so3_exp(rotation_rad), translation_m};
}

/// `count` poses 1 m apart along x, facing forward.
std::vector<PosePair> straight_line(std::size_t count) {
  std::vector<PosePair> pairs(count);
  for (std::size_t i = 0; i < count; ++i) {
    pairs[i].stamp = host_time_from_ns(static_cast<std::int64_t>(i) * 100'000'000);
    pairs[i].reference.translation_m.x() = static_cast<double>(i);
    pairs[i].estimate = pairs[i].reference;
  }
  return pairs;
}

std::vector<PosePair> random_walk(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<PosePair> pairs = straight_line(count);
  for (PosePair& pair : pairs) {
    for (int axis = 0; axis < 3; ++axis) pair.reference.translation_m[axis] += normal(random);
    pair.reference.rotation = geometry::so3_exp({normal(random), normal(random), normal(random)});
    pair.estimate = pair.reference;
  }
  return pairs;
}

TEST(Statistics, OfKnownNumbers) {
  const ErrorStatistics s = statistics_of({4.0, 1.0, 3.0, 2.0});
  EXPECT_EQ(s.count, 4U);
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(30.0 / 4.0));
  EXPECT_DOUBLE_EQ(s.stddev, std::sqrt(1.25));
  EXPECT_EQ(s.min, 1.0);
  EXPECT_EQ(s.max, 4.0);
  EXPECT_DOUBLE_EQ(statistics_of({7.0, 1.0, 5.0}).median, 5.0);
  EXPECT_EQ(statistics_of({}).count, 0U);
}

TEST(Align, UndoesARigidMotion) {
  auto pairs = random_walk(50, 3);
  const RigidTransform moved = transform({0.3, -1.2, 2.0}, {5, -7, 11});
  for (PosePair& pair : pairs) pair.estimate = moved * pair.reference;
  const RigidTransform found = align(pairs);
  EXPECT_LT((found * moved).translation_m.norm(), 1e-9);
  EXPECT_LT(geometry::so3_log((found * moved).rotation).norm(), 1e-9);
  EXPECT_LT(statistics_of(absolute_errors_m(pairs, found)).max, 1e-9);
}

TEST(Align, NeverReflects) {
  auto pairs = random_walk(50, 4);
  for (PosePair& pair : pairs) pair.estimate.translation_m.x() *= -1.0;  // a mirror image cannot be aligned
  const RigidTransform found = align(pairs);
  EXPECT_NEAR(found.rotation.toRotationMatrix().determinant(), 1.0, 1e-9);
  EXPECT_GT(statistics_of(absolute_errors_m(pairs, found)).rmse, 0.5);
}

TEST(Align, HandlesFewAndCollinearPairs) {
  EXPECT_TRUE(align({}).is_finite());
  auto one = straight_line(1);
  one[0].estimate.translation_m = {1, 2, 3};
  EXPECT_EQ(align(one).translation_m, Eigen::Vector3d(-1, -2, -3));
  auto line = straight_line(10);
  for (PosePair& pair : line) pair.estimate = transform({0, 0, 1.0}, {1, 2, 3}) * pair.reference;
  const RigidTransform found = align(line);
  EXPECT_TRUE(found.is_finite());
  EXPECT_LT(statistics_of(absolute_errors_m(line, found)).max, 1e-9);
}

TEST(AbsoluteErrors, AlternatingOffsetIsItsOwnRmse) {
  auto pairs = straight_line(1000);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    pairs[i].estimate.translation_m.z() += i % 2 == 0 ? 0.1 : -0.1;
  const auto result = evaluate(pairs);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->absolute_m.rmse, 0.1, 1e-6);
  EXPECT_NEAR(result->absolute_m.median, 0.1, 1e-3);
}

TEST(RelativeErrors, ConstantScaleErrorPerFrameAndPerMetre) {
  auto pairs = straight_line(21);
  for (PosePair& pair : pairs) pair.estimate.translation_m *= 1.02;
  const RelativeErrors frame = relative_errors_per_frame(pairs);
  EXPECT_EQ(frame.translation_m.count, 20U);
  EXPECT_NEAR(frame.translation_m.rmse, 0.02, 1e-12);
  EXPECT_NEAR(frame.rotation_deg.max, 0.0, 1e-9);
  const RelativeErrors five = relative_errors_per_distance(pairs, 5.0);
  EXPECT_EQ(five.translation_m.count, 4U);
  EXPECT_NEAR(five.translation_m.mean, 0.1, 1e-12);
  EXPECT_EQ(relative_errors_per_distance(pairs, 100.0).translation_m.count, 0U);
}

TEST(RelativeErrors, YawDriftShowsAsDegreesPerFrame) {
  auto pairs = straight_line(100);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].estimate.rotation =
        geometry::so3_exp({0, 0, static_cast<double>(i) * 0.5 * std::numbers::pi / 180.0});
  }
  EXPECT_NEAR(relative_errors_per_frame(pairs).rotation_deg.mean, 0.5, 1e-9);
}

TEST(EndToEnd, SeesDriftThatAlignmentHides) {
  auto pairs = straight_line(101);
  const double yaw_rad = 0.01;
  for (PosePair& pair : pairs) {
    // A wrong heading from the start, over 100 m: global alignment removes it whole.
    pair.estimate.translation_m = geometry::so3_exp({0, 0, yaw_rad}) * pair.reference.translation_m;
  }
  const EndToEndError error = end_to_end_error(pairs);
  EXPECT_NEAR(error.distance_m, 200.0 * std::sin(yaw_rad / 2), 1e-9);
  EXPECT_NEAR(error.percent_of_path, error.distance_m, 1e-9);
  EXPECT_NEAR(statistics_of(absolute_errors_m(pairs, align(pairs))).rmse, 0.0, 1e-9);
}

TEST(EndToEnd, IgnoresTheChoiceOfWorldFrame) {
  auto pairs = random_walk(30, 5);
  pairs.back().estimate.translation_m += Eigen::Vector3d(0, 3, 4);
  for (PosePair& pair : pairs) pair.estimate = transform({1, 2, -1}, {9, 8, 7}) * pair.estimate;
  EXPECT_NEAR(end_to_end_error(pairs).distance_m, 5.0, 1e-9);
}

TEST(Kitti, ScaleErrorIsTheSamePercentageForEveryLength) {
  auto pairs = straight_line(1001);
  for (PosePair& pair : pairs) pair.estimate.translation_m *= 1.01;
  const auto errors = kitti_errors(pairs);
  ASSERT_TRUE(errors);
  // A segment ends at the first frame beyond its length: 101 m for 100 m, as in the devkit.
  double expected = 0.0;
  std::size_t segments = 0;
  for (int first = 0; first < 1001; first += 10) {
    for (int length = 100; length <= 800; length += 100) {
      if (first + length + 1 > 1000) continue;
      expected += 100.0 * 0.01 * (length + 1) / length;
      ++segments;
    }
  }
  EXPECT_EQ(errors->segments, segments);
  EXPECT_NEAR(errors->translation_percent, expected / static_cast<double>(segments), 1e-9);
  EXPECT_NEAR(errors->rotation_deg_per_m, 0.0, 1e-9);
}

TEST(Kitti, RotationIsPerMetre) {
  auto pairs = straight_line(150);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].estimate.rotation = geometry::so3_exp({static_cast<double>(i) * 1e-4, 0, 0});
  }
  const auto errors = kitti_errors(pairs);
  ASSERT_TRUE(errors);
  EXPECT_NEAR(errors->rotation_deg_per_m, 101.0 * 1e-4 * 180.0 / std::numbers::pi / 100.0, 1e-9);
}

TEST(Kitti, ShortPathsHaveNoValue) {
  EXPECT_FALSE(kitti_errors(straight_line(101)));  // exactly 100 m: no frame lies beyond
  EXPECT_FALSE(kitti_errors({}));
  const std::array<double, 1> short_m = {5.0};
  EXPECT_TRUE(kitti_errors(straight_line(101), short_m));
}

TEST(Evaluate, WantsTwoPairs) {
  EXPECT_FALSE(evaluate(straight_line(1)));
  const auto result = evaluate(straight_line(2));
  ASSERT_TRUE(result);
  EXPECT_DOUBLE_EQ(result->path_m, 1.0);
  EXPECT_DOUBLE_EQ(result->duration_s, 0.1);
}

}  // namespace
}  // namespace edgesplat::accuracy
