// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/accuracy/association.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace edgesplat::accuracy {
namespace {

io::StampedPose pose_at(double stamp_s, double x_m) {
  io::StampedPose pose;
  pose.stamp = host_time_from_ns(from_seconds(stamp_s).count());
  pose.world_from_body.translation_m.x() = x_m;
  return pose;
}

constexpr auto kMaxDiff = from_seconds(0.01);

TEST(Associate, PairsNearestStamps) {
  const std::vector<io::StampedPose> estimate = {pose_at(1.0, 10), pose_at(2.0, 20)};
  const std::vector<io::StampedPose> reference = {pose_at(0.995, 1), pose_at(1.003, 2), pose_at(1.5, 3),
                                                  pose_at(1.999, 4), pose_at(2.004, 5)};
  const auto pairs = associate(estimate, reference, kMaxDiff);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].reference.translation_m.x(), 2);
  EXPECT_EQ(pairs[1].reference.translation_m.x(), 4);
  EXPECT_EQ(pairs[1].estimate.translation_m.x(), 20);
  EXPECT_EQ(pairs[1].stamp, estimate[1].stamp);
}

TEST(Associate, LeavesOutWhatIsTooFarAndKeepsTheLimitItself) {
  const std::vector<io::StampedPose> estimate = {pose_at(1.0, 1), pose_at(2.0, 2)};
  const std::vector<io::StampedPose> reference = {pose_at(1.010, 1), pose_at(2.0101, 2), pose_at(9, 9)};
  const auto pairs = associate(estimate, reference, kMaxDiff);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].estimate.translation_m.x(), 1);
}

TEST(Associate, TheShorterTrajectoryDecidesHowManyPairs) {
  const std::vector<io::StampedPose> estimate = {pose_at(1.000, 1), pose_at(1.002, 2), pose_at(1.004, 3)};
  const std::vector<io::StampedPose> reference = {pose_at(1.003, 7)};
  const auto pairs = associate(estimate, reference, kMaxDiff);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].estimate.translation_m.x(), 2);  // ties go to the earlier one
  EXPECT_EQ(pairs[0].reference.translation_m.x(), 7);
}

TEST(Associate, SortsUnsortedInput) {
  const std::vector<io::StampedPose> estimate = {pose_at(2.0, 2), pose_at(1.0, 1)};
  const std::vector<io::StampedPose> reference = {pose_at(3.0, 3), pose_at(1.0, 1), pose_at(2.0, 2)};
  const auto pairs = associate(estimate, reference, kMaxDiff);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_LT(pairs[0].stamp, pairs[1].stamp);
  for (const auto& pair : pairs) EXPECT_EQ(pair.estimate.translation_m, pair.reference.translation_m);
}

TEST(Associate, EmptyTrajectoriesGiveNoPairs) {
  const std::vector<io::StampedPose> one = {pose_at(1.0, 1)};
  EXPECT_TRUE(associate({}, one, kMaxDiff).empty());
  EXPECT_TRUE(associate(one, {}, kMaxDiff).empty());
}

class ReadReference : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    auto path = std::filesystem::path(testing::TempDir()) / ("accuracy_association_" + name);
    std::ofstream(path) << text;
    return path;
  }
  const std::string two_poses_ = "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 5 0 1 0 0 0 0 1 0\n";
};

TEST_F(ReadReference, KittiPosesGetTheirRatesStamps) {
  const ReferenceSource source{write("a.txt", two_poses_), ReferenceFormat::kKitti, std::nullopt, 10.0};
  const auto poses = read_reference(source, host_time_from_ns(7'000'000'000));
  ASSERT_TRUE(poses) << poses.error().context;
  ASSERT_EQ(poses->size(), 2U);
  EXPECT_EQ(to_ns((*poses)[0].stamp), 7'000'000'000);
  EXPECT_EQ(to_ns((*poses)[1].stamp), 7'100'000'000);
  EXPECT_EQ((*poses)[1].world_from_body.translation_m.x(), 5);
}

TEST_F(ReadReference, TimesMustMatchThePosesInNumber) {
  ReferenceSource source{write("b.txt", two_poses_), ReferenceFormat::kKitti,
                         write("times.txt", "0.5\n0.75\n"), 10.0};
  const auto poses = read_reference(source, HostTime{});
  ASSERT_TRUE(poses) << poses.error().context;
  EXPECT_EQ(to_ns((*poses)[1].stamp), 750'000'000);

  source.times = write("short.txt", "0.5\n");
  const auto mismatch = read_reference(source, HostTime{});
  ASSERT_FALSE(mismatch);
  EXPECT_EQ(mismatch.error().code, Errc::kInvalidArgument);
}

TEST(AssociateInterpolated, TakesTheReferenceAtTheEstimatesMoment) {
  const std::vector<io::StampedPose> estimate = {pose_at(0.5, 0), pose_at(1.0, 1), pose_at(1.025, 2),
                                                 pose_at(2.5, 3), pose_at(9.0, 4)};
  std::vector<io::StampedPose> reference = {pose_at(1.0, 10), pose_at(1.1, 20), pose_at(4.0, 30)};
  reference[1].world_from_body.rotation = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ());
  const auto pairs = associate_interpolated(estimate, reference, from_seconds(0.15));
  ASSERT_EQ(pairs.size(), 2U);  // before all, in the gap and behind all: left out
  EXPECT_EQ(pairs[0].reference.translation_m.x(), 10);
  EXPECT_NEAR(pairs[1].reference.translation_m.x(), 12.5, 1e-9);
  EXPECT_NEAR(pairs[1].reference.rotation.angularDistance(Eigen::Quaterniond::Identity()), 0.1, 1e-9);
  EXPECT_EQ(pairs[1].estimate.translation_m.x(), 2);
}

}  // namespace
}  // namespace edgesplat::accuracy
