// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/pointcloud/deskew.hpp"

#include "common/geometry/so3.hpp"
#include "test/support/random.hpp"
#include "test/support/simd_limit.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

namespace edgesplat::pointcloud {
namespace {

constexpr std::int32_t kSweep_ns = 100'000'000;

/// A body that turns and drives at constant rates, seen from its pose at the end of the sweep.
geometry::RigidTransform end_from_sensor(double before_end_s) {
  return {geometry::so3_exp(-before_end_s * Eigen::Vector3d(0.3, -0.5, 2.0)),
          -before_end_s * Eigen::Vector3d(5.0, 0.4, -0.2)};
}

std::vector<MotionKnot> knots(int count) {
  std::vector<MotionKnot> all;
  for (int i = 0; i < count; ++i) {
    const std::int32_t before_end_ns = kSweep_ns - kSweep_ns / (count - 1) * i;
    all.push_back({before_end_ns, end_from_sensor(before_end_ns * 1e-9)});
  }
  return all;
}

TEST(Deskew, PutsTheRaysOfAMovingSensorBackInPlace) {
  test::Random random(1);
  std::vector<Eigen::Vector3f> truth, measured;
  std::vector<std::int32_t> times;
  for (int i = 0; i < 500; ++i) {
    times.push_back(static_cast<std::int32_t>(random.uniform(0, kSweep_ns)));
    const Eigen::Vector3d p_at_end = random.vector(50.0);
    truth.push_back(p_at_end.cast<float>());
    measured.push_back((end_from_sensor(times.back() * 1e-9).inverse() * p_at_end).cast<float>());
  }
  std::vector<Eigen::Vector3f> moved(measured.size());
  deskew(measured, times, knots(21), moved);
  // Rotation and translation are interpolated apart, and 32-bit floats hold 50 m to 4 um.
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_LT((moved[i] - truth[i]).norm(), 2e-4F) << times[i];
}

TEST(Deskew, OneKnotMovesAllPointsAlike) {
  const std::vector<Eigen::Vector3f> points = {{1, 2, 3}, {4, 5, 6}};
  const std::vector<std::int32_t> times = {0, 50'000'000};
  std::vector<Eigen::Vector3f> moved(2);
  const geometry::RigidTransform shift{Eigen::Quaterniond::Identity(), {1.0, 0.0, -1.0}};
  deskew(points, times, std::vector<MotionKnot>{{0, shift}}, moved);
  EXPECT_TRUE(moved[0].isApprox(Eigen::Vector3f(2, 2, 2)));
  EXPECT_TRUE(moved[1].isApprox(Eigen::Vector3f(5, 5, 5)));
}

TEST(Deskew, TimesOutsideTheMotionTakeItsEnds) {
  const std::vector<Eigen::Vector3f> points = {{1, 0, 0}, {1, 0, 0}};
  const std::vector<std::int32_t> times = {kSweep_ns * 10, 0};
  std::vector<Eigen::Vector3f> moved(2);
  std::vector<MotionKnot> motion = knots(11);
  motion.pop_back();  // the last knot is then 10 ms before the end
  deskew(points, times, motion, moved);
  EXPECT_TRUE(
      moved[0].cast<double>().isApprox(motion.front().end_from_sensor * Eigen::Vector3d(1, 0, 0), 1e-5));
  EXPECT_TRUE(
      moved[1].cast<double>().isApprox(motion.back().end_from_sensor * Eigen::Vector3d(1, 0, 0), 1e-5));
}

// Trajectories are compared bit by bit between machines: a point must not depend on the vector it came in.
TEST(Deskew, GivesTheSameBitsWithEveryInstructionSet) {
  test::Random random(2);
  std::vector<Eigen::Vector3f> points;
  std::vector<std::int32_t> times;
  for (int i = 0; i < 1003; ++i) {
    points.push_back(random.vector(50.0).cast<float>());
    times.push_back(i * 99'991 + 1);  // never just at a knot, where either side would do
  }
  std::vector<Eigen::Vector3f> alone(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    deskew({&points[i], 1}, {&times[i], 1}, knots(21), {&alone[i], 1});
  for (const core::SimdLevel level : core::available_simd_levels()) {
    const test::SimdLimit limit(level);
    std::vector<Eigen::Vector3f> moved(points.size());
    deskew(points, times, knots(21), moved);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(std::memcmp(moved[i].data(), alone[i].data(), sizeof(Eigen::Vector3f)), 0)
          << core::to_string(level) << ' ' << i;
    }
  }
}

TEST(Deskew, AnEmptyCloudAndNotANumberPassThrough) {
  deskew({}, {}, knots(3), {});
  std::vector<Eigen::Vector3f> points = {{std::numeric_limits<float>::quiet_NaN(), 0, 0}, {1, 1, 1}};
  const std::vector<std::int32_t> times = {10, 0};
  deskew(points, times, knots(3), points);
  EXPECT_FALSE(points[0].allFinite());
  EXPECT_TRUE(points[1].isApprox(Eigen::Vector3f(1, 1, 1)));
}

}  // namespace
}  // namespace edgesplat::pointcloud
