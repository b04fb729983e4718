// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/track_keeper.hpp"

#include "robot/tracking/relocalise.hpp"
#include "test/robot/tracking/painted_room.hpp"

#include <gtest/gtest.h>

namespace edgesplat::tracking {
namespace {

ScanUpdateResult scan_with(int used, int matched) {
  ScanUpdateResult scan;
  scan.updated = true;
  scan.last.used = used;
  scan.last.matched = matched;
  return scan;
}

GroupEvidence evidence(bool scan, bool all, bool picture) {
  return {scan, all, picture, 0.01, 0.1};
}

TEST(TrackKeeper, AScanIsHeldAgainstTheOnesBefore) {
  TrackKeeper keeper;
  EXPECT_TRUE(keeper.fits(scan_with(100, 1000)));  // nothing to compare with yet
  for (int i = 0; i < 50; ++i) keeper.learn(scan_with(900, 1000));
  EXPECT_TRUE(keeper.fits(scan_with(700, 1000)));
  EXPECT_FALSE(keeper.fits(scan_with(400, 1000)));
  ScanUpdateResult none = scan_with(900, 1000);
  none.updated = false;
  EXPECT_FALSE(keeper.fits(none));
}

TEST(TrackKeeper, SaysWhatIsMissing) {
  TrackKeeper keeper;
  EXPECT_EQ(keeper.next(evidence(true, true, false)), TrackingState::kTracking);
  EXPECT_EQ(keeper.next(evidence(true, false, false)), TrackingState::kDegraded);
  EXPECT_EQ(keeper.next(evidence(true, false, true)), TrackingState::kTracking);
  EXPECT_EQ(keeper.next(evidence(false, false, true)), TrackingState::kDegraded);
  EXPECT_EQ(keeper.next(evidence(false, false, false)), TrackingState::kCoasting);
}

TEST(TrackKeeper, GoesFromCoastingOverLostToRecovered) {
  TrackKeeper keeper;
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(keeper.next(evidence(false, false, false)), TrackingState::kCoasting) << i;
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(keeper.next(evidence(false, false, false)), TrackingState::kLost) << i;
  // A picture alone does not say where in the map the body is.
  EXPECT_EQ(keeper.next(evidence(false, false, true)), TrackingState::kLost);
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(keeper.next(evidence(true, true, false)), TrackingState::kRecovered) << i;
  EXPECT_EQ(keeper.next(evidence(true, true, false)), TrackingState::kTracking);
}

TEST(TrackKeeper, ADoubtfulPositionIsLostAtOnce) {
  TrackKeeper keeper;
  GroupEvidence blind = evidence(false, false, false);
  blind.position_sigma_m = 2.0;
  EXPECT_EQ(keeper.next(blind), TrackingState::kLost);
}

TEST(LikelyPoses, HoldTheTrueOneNearTheTop) {
  PlaneMap planes{PlaneMapConfig{}};
  test::PaintedRoom::map(planes);
  const geometry::RigidTransform truth{Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ())),
                                       {1.0, 0.5, 0.1}};
  const auto scan = test::PaintedRoom::scan(truth, 1000);
  const geometry::RigidTransform guess{Eigen::Quaterniond(Eigen::AngleAxisd(0.36, Eigen::Vector3d::UnitZ())),
                                       {3.2, -0.9, 0.6}};
  for (const int threads : {1, 2}) {
    BlockLoop loop(threads);
    const auto poses = likely_poses(planes, scan, guess, {}, loop, 6);
    ASSERT_EQ(poses.size(), 6U);
    const bool found = std::ranges::any_of(poses, [&](const geometry::RigidTransform& pose) {
      return (pose.translation_m - truth.translation_m).norm() < 0.5 &&
             pose.rotation.angularDistance(truth.rotation) < 0.1;
    });
    EXPECT_TRUE(found);
  }
}

}  // namespace
}  // namespace edgesplat::tracking
