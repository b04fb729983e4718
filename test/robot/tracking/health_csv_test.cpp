// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/health_csv.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace edgesplat::tracking {
namespace {

TEST(HealthCsv, HasAValueForEveryColumn) {
  TrackingHealth health;
  health.state = TrackingState::kCoasting;
  health.points_used = 17;
  health.frozen_directions = 1;
  health.weakest.step_in_odom = {1.0, 0.0, 0.0};
  const std::string line = health_csv(health);
  EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(health_csv_header(), ','));
  EXPECT_TRUE(line.starts_with("coasting,17,")) << line;
}

}  // namespace
}  // namespace edgesplat::tracking
