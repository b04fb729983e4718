// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// What goes wrong in the field, injected into a simulated drive: tracking never crashes, its pose stays
// finite, it says how it stands, and it finds its way back.
#include "robot/tracking/tracker.hpp"
#include "test/support/simulated_groups.hpp"
#include "test/tools/simulate/box_world.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

namespace edgesplat::tracking {
namespace {

const simulate::BoxWorld kRoom;
constexpr int kFault = 60;  // the group in which faults begin: 6 s, the robot drives

struct Step {
  TrackingState state;
  double error_m;  ///< of the position, both aligned at the first pose
};

struct Drive {
  std::vector<Step> steps;
  TrackingCounters counters;
  int refused = 0;

  [[nodiscard]] int groups_in(TrackingState state) const {
    return static_cast<int>(std::ranges::count(steps, state, &Step::state));
  }
  /// Groups from the fault's end to the first of a second in which the pose is known again.
  [[nodiscard]] int groups_to_recover(int fault_end, double error_m) const {
    for (std::size_t i = static_cast<std::size_t>(fault_end); i + 10 < steps.size(); ++i) {
      const bool good = std::all_of(steps.begin() + static_cast<std::ptrdiff_t>(i),
                                    steps.begin() + static_cast<std::ptrdiff_t>(i) + 10,
                                    [&](const Step& s) { return s.error_m < error_m; });
      if (good) return static_cast<int>(i) - fault_end;
    }
    return 1000;
  }
};

/// `spoil` may change a group; nothing of it is given to the tracker where it returns false.
Drive drive(double duration_s, const std::function<bool(int, sync::MeasureGroup&)>& spoil) {
  test::SimulatedDriveConfig config;
  config.trajectory.duration_s = duration_s;
  config.keep_every_packet = 4;
  test::SimulatedDrive source(kRoom, config);
  auto tracker = Tracker::create({}, source.rig());
  EXPECT_TRUE(tracker.has_value());
  Drive result;
  std::optional<geometry::RigidTransform> odom_from_world;
  for (int i = 0; auto group = source.next(); ++i) {
    if (!spoil(i, *group)) continue;
    const auto tracked = (*tracker)->track(*group);
    if (!tracked) {
      ++result.refused;
      continue;
    }
    EXPECT_TRUE(tracked->odom_from_body.is_finite()) << i;
    EXPECT_TRUE(tracked->pose_covariance.allFinite()) << i;
    const auto truth = source.truth(group->end).world_from_body;
    if (!odom_from_world && tracked->health.state != TrackingState::kInitialising)
      odom_from_world = tracked->odom_from_body * truth.inverse();
    const double error_m =
        odom_from_world
            ? (tracked->odom_from_body.translation_m - (*odom_from_world * truth).translation_m).norm()
            : 0.0;
    result.steps.push_back({tracked->health.state, error_m});
  }
  result.counters = (*tracker)->counters();
  return result;
}

bool between(int i, int first, int last) {
  return i >= first && i < last;
}

TEST(Fault, ASecondWithoutLidarIsCoasted) {
  const Drive result = drive(10.0, [](int i, sync::MeasureGroup& group) {
    if (between(i, kFault, kFault + 10)) group.points.clear();
    return true;
  });
  EXPECT_EQ(result.groups_in(TrackingState::kCoasting), 10);
  EXPECT_EQ(result.groups_in(TrackingState::kLost), 0);
  EXPECT_LE(result.groups_to_recover(kFault + 10, 0.05), 1);
}

TEST(Fault, FiveSecondsWithoutLidarAreLostAndRecovered) {
  const Drive result = drive(16.0, [](int i, sync::MeasureGroup& group) {
    if (between(i, kFault, kFault + 50)) group.points.clear();
    return true;
  });
  const auto state = [&](int i) { return result.steps[static_cast<std::size_t>(i)].state; };
  EXPECT_EQ(state(kFault - 1), TrackingState::kTracking);
  EXPECT_EQ(state(kFault + 5), TrackingState::kCoasting);
  EXPECT_EQ(state(kFault + 45), TrackingState::kLost);
  EXPECT_GT(result.groups_in(TrackingState::kRecovered), 5);
  EXPECT_EQ(result.steps.back().state, TrackingState::kTracking);
  EXPECT_LE(result.groups_to_recover(kFault + 50, 0.1), 15);
  EXPECT_EQ(result.counters.recoveries, 1);
}

TEST(Fault, ThirtySecondsWithoutLidarEndInAMapAgain) {
  const Drive result = drive(60.0, [](int i, sync::MeasureGroup& group) {
    if (between(i, kFault, kFault + 300)) group.points.clear();
    return true;
  });
  EXPECT_EQ(result.steps.back().state, TrackingState::kTracking);
  EXPECT_GE(result.counters.recoveries + result.counters.map_restarts, 1);
}

TEST(Fault, AJumpIsNoticed) {
  // The robot is carried off for 4 s while everything is switched off.
  const Drive result =
      drive(20.0, [](int i, sync::MeasureGroup&) { return !between(i, kFault, kFault + 40); });
  EXPECT_EQ(result.steps.back().state, TrackingState::kTracking);
  EXPECT_LT(result.steps.back().error_m, 0.2);
}

TEST(Fault, AnImuGapIsBridged) {
  const Drive result = drive(12.0, [](int i, sync::MeasureGroup& group) {
    if (between(i, kFault, kFault + 10)) group.imu.clear();
    return true;
  });
  EXPECT_EQ(result.counters.imu_gaps, 10);
  EXPECT_EQ(result.steps.back().state, TrackingState::kTracking);
  EXPECT_LT(result.steps.back().error_m, 0.06);
}

TEST(Fault, StuckAndBackwardStampsAreRefused) {
  HostTime stuck{};
  const Drive result = drive(10.0, [&stuck](int i, sync::MeasureGroup& group) {
    if (i == kFault) stuck = group.end;
    if (between(i, kFault + 1, kFault + 4)) group.begin = group.end = stuck;
    if (i == kFault + 5) group.end = group.begin - std::chrono::milliseconds(50);
    return true;
  });
  EXPECT_EQ(result.refused, 4);
  EXPECT_EQ(result.steps.back().state, TrackingState::kTracking);
  EXPECT_LT(result.steps.back().error_m, 0.06);
}

TEST(Fault, DuplicatedPointsAndSamplesChangeLittle) {
  const Drive result = drive(10.0, [](int i, sync::MeasureGroup& group) {
    if (i < kFault) return true;
    const auto points = group.points;
    group.points.insert(group.points.end(), points.begin(), points.end());
    const auto imu = group.imu;
    for (const sync::GroupImu& sample : imu) group.imu.insert(group.imu.end(), 2, sample);
    return true;
  });
  EXPECT_LT(result.steps.back().error_m, 0.06);
  EXPECT_EQ(result.groups_in(TrackingState::kCoasting), 0);
}

TEST(Fault, RubbishInEveryFieldIsCounted) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  const Drive result = drive(10.0, [&](int i, sync::MeasureGroup& group) {
    if (i < kFault) return true;
    for (std::size_t k = 0; k < group.points.size(); k += 3) {
      Eigen::Vector3f& p = group.points[k].p_in_lidar_m;
      p = k % 2 == 0 ? Eigen::Vector3f(nan, p.y(), infinite) : Eigen::Vector3f::Zero();
    }
    for (std::size_t k = 0; k < group.imu.size(); k += 4)
      group.imu[k].gyro_radps.x() = static_cast<double>(nan);
    return true;
  });
  EXPECT_GT(result.counters.bad_points, 1000);
  EXPECT_GT(result.counters.bad_imu_samples, 100);
  EXPECT_EQ(result.steps.back().state, TrackingState::kTracking);
  EXPECT_LT(result.steps.back().error_m, 0.06);
}

TEST(Fault, ScansOfOnePointOrOneDirectionAreSurvived) {
  const Drive result = drive(12.0, [](int i, sync::MeasureGroup& group) {
    if (between(i, kFault, kFault + 5)) group.points.resize(1);
    if (between(i, kFault + 10, kFault + 15)) {
      for (sync::GroupPoint& point : group.points) point.p_in_lidar_m = group.points[0].p_in_lidar_m;
    }
    return true;
  });
  EXPECT_EQ(result.steps.back().state, TrackingState::kTracking);
  EXPECT_LT(result.steps.back().error_m, 0.08);
}

TEST(Fault, AScanOfNoiseDoesNotSpoilTheMap) {
  std::uint64_t seed = 1;
  const Drive result = drive(12.0, [&seed](int i, sync::MeasureGroup& group) {
    if (!between(i, kFault, kFault + 10)) return true;
    for (sync::GroupPoint& point : group.points) {
      for (int axis = 0; axis < 3; ++axis) {
        seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
        point.p_in_lidar_m(axis) = static_cast<float>(seed >> 40U) / 16777216.0F * 6.0F - 3.0F;
      }
    }
    return true;
  });
  EXPECT_EQ(result.steps.back().state, TrackingState::kTracking);
  EXPECT_LT(result.steps.back().error_m, 0.1);
}

}  // namespace
}  // namespace edgesplat::tracking
