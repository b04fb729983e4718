// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/lidar_pattern.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace edgesplat::simulate {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

double yaw_deg(const Eigen::Vector3d& d) {
  return std::atan2(d.y(), d.x()) * kDegrees;
}
double pitch_deg(const Eigen::Vector3d& d) {
  return std::asin(d.z()) * kDegrees;
}

// How many cells of one degree are seen within `seconds`.
std::size_t cells_seen(LidarKind kind, double seconds) {
  const LidarPattern pattern{kind};
  std::set<std::pair<int, int>> cells;
  const auto shots = static_cast<std::uint64_t>(seconds * pattern.shots_per_s());
  for (std::uint64_t shot = 0; shot < shots; ++shot) {
    const Eigen::Vector3d d = pattern.direction(shot);
    cells.emplace(static_cast<int>(std::floor(yaw_deg(d))), static_cast<int>(std::floor(pitch_deg(d))));
  }
  return cells.size();
}

TEST(LidarPattern, Mid360LooksAroundFromMinus7To52Degrees) {
  const LidarPattern pattern{LidarKind::kMid360};
  double low = 90, high = -90, left = -360, right = 360;
  for (std::uint64_t shot = 0; shot < 200000; ++shot) {
    const Eigen::Vector3d d = pattern.direction(shot);
    ASSERT_NEAR(d.norm(), 1.0, 1e-12);
    low = std::min(low, pitch_deg(d)), high = std::max(high, pitch_deg(d));
    right = std::min(right, yaw_deg(d)), left = std::max(left, yaw_deg(d));
  }
  EXPECT_NEAR(low, -7.0, 0.05);
  EXPECT_NEAR(high, 52.0, 0.05);
  EXPECT_NEAR(right, -180.0, 0.05);
  EXPECT_NEAR(left, 180.0, 0.05);
}

TEST(LidarPattern, AviaLooksAhead70By77Degrees) {
  const LidarPattern pattern{LidarKind::kAvia};
  double low = 90, high = -90, left = -360, right = 360;
  for (std::uint64_t shot = 0; shot < 480000; ++shot) {
    const Eigen::Vector3d d = pattern.direction(shot);
    low = std::min(low, pitch_deg(d)), high = std::max(high, pitch_deg(d));
    right = std::min(right, yaw_deg(d)), left = std::max(left, yaw_deg(d));
  }
  EXPECT_NEAR(high - low, 77.2, 0.3);
  EXPECT_NEAR(left - right, 70.4, 0.3);
}

TEST(LidarPattern, FiresAtTheDataSheetsRate) {
  EXPECT_EQ(LidarPattern{LidarKind::kMid360}.shot_period_ns(), 5000);
  EXPECT_NEAR(1e9 / static_cast<double>(LidarPattern{LidarKind::kAvia}.shot_period_ns()), 240e3, 30.0);
  EXPECT_EQ(LidarPattern{LidarKind::kMid360}.line(7), 3U);
  EXPECT_EQ(LidarPattern{LidarKind::kAvia}.line(7), 1U);
}

TEST(LidarPattern, Mid360CoverageGrowsUntilNothingIsLeft) {
  constexpr double kField = 360.0 * 59.0;
  const double after_100ms = static_cast<double>(cells_seen(LidarKind::kMid360, 0.1)) / kField;
  const double after_500ms = static_cast<double>(cells_seen(LidarKind::kMid360, 0.5)) / kField;
  const double after_3s = static_cast<double>(cells_seen(LidarKind::kMid360, 3.0)) / kField;
  EXPECT_GT(after_100ms, 0.35);
  EXPECT_GT(after_500ms, after_100ms + 0.1);
  EXPECT_GT(after_3s, 0.99);
}

TEST(LidarPattern, AviaCoverageGrows) {
  const std::size_t in_the_end = cells_seen(LidarKind::kAvia, 5.0);
  const std::size_t missing_after_100ms = in_the_end - cells_seen(LidarKind::kAvia, 0.1);
  const std::size_t missing_after_500ms = in_the_end - cells_seen(LidarKind::kAvia, 0.5);
  EXPECT_GT(static_cast<double>(in_the_end), 0.95 * 70.4 * 77.2 * std::numbers::pi / 4.0);
  EXPECT_GT(static_cast<double>(missing_after_100ms), 0.15 * static_cast<double>(in_the_end));
  EXPECT_LT(missing_after_500ms, missing_after_100ms / 4);
}

}  // namespace
}  // namespace edgesplat::simulate
