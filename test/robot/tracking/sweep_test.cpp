// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/sweep.hpp"

#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace edgesplat::tracking {
namespace {

class SweepOfABody : public testing::Test {
 protected:
  void load(int points) {
    test::Random random(1);
    sync::MeasureGroup group;
    group.end = kEnd;
    group.begin = kEnd - from_seconds(0.1);
    for (int i = 0; i < points; ++i) {
      sync::GroupPoint point;
      point.p_in_lidar_m = random.vector(5.0).cast<float>();
      group.points.push_back(point);
    }
    sweep.load(group, counters);
  }
  void deskew(double shift_m) {
    const std::vector<PathKnot> path = {{kEnd, {}}};
    sweep.deskew(path, {Eigen::Quaterniond::Identity(), {shift_m, 0.0, 0.0}}, {});
  }

  static constexpr HostTime kEnd{std::chrono::seconds(10)};
  BlockLoop loop{1};
  Sweep sweep{sensor::Rig{}, 100.0, loop};
  TrackingCounters counters;
};

std::vector<std::uint32_t> copy(std::span<const std::uint32_t> indices) {
  return {indices.begin(), indices.end()};
}

TEST_F(SweepOfABody, ThinsAsTheDownsamplerDoesWithEveryEdge) {
  load(3000);
  pointcloud::VoxelDownsampler downsampler;
  for (const double shift_m : {0.0, 0.25}) {
    deskew(shift_m);
    const auto wide = copy(sweep.thinned(1.0));
    EXPECT_EQ(wide, copy(downsampler.run(sweep.points_in_body_m(), 1.0F)));
    const auto narrow = copy(sweep.thinned(0.5));
    EXPECT_EQ(narrow, copy(downsampler.run(sweep.points_in_body_m(), 0.5F)));
    EXPECT_LT(wide.size(), narrow.size());
    // Asked again, the first is as it was.
    EXPECT_EQ(copy(sweep.thinned(1.0)), wide);
  }
}

TEST_F(SweepOfABody, ThinsWhatTheNewestDeskewingLeft) {
  load(1000);
  deskew(0.0);
  const auto before = copy(sweep.thinned(1.0));
  deskew(0.5);
  EXPECT_NE(copy(sweep.thinned(1.0)), before);
}

}  // namespace
}  // namespace edgesplat::tracking
