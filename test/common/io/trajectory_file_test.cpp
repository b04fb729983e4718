// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/trajectory_file.hpp"

#include "common/io/atomic_file.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace edgesplat::io {
namespace {

using ::testing::HasSubstr;

std::optional<std::int64_t> parse_ns(std::string_view text) {
  const auto stamp = parse_decimal_seconds(text);
  if (!stamp) return std::nullopt;
  return to_ns(*stamp);
}

TEST(DecimalSeconds, AreExactToTheNanosecond) {
  EXPECT_EQ(parse_ns("1403636579.763555527"), 1'403'636'579'763'555'527);  // a double would be 65 ns off
  EXPECT_EQ(parse_ns("0.000000001"), 1);
  EXPECT_EQ(parse_ns("12"), 12'000'000'000);
  EXPECT_EQ(parse_ns("12."), 12'000'000'000);
  EXPECT_EQ(parse_ns(".5"), 500'000'000);
  EXPECT_EQ(parse_ns("-0.25"), -250'000'000);
  EXPECT_EQ(parse_ns("+007"), 7'000'000'000);
  EXPECT_EQ(parse_ns("1.036224e-01"), 103'622'400);  // KITTI's times.txt
  EXPECT_EQ(parse_ns("1.403636579763555527e+09"), 1'403'636'579'763'555'527);
  EXPECT_EQ(parse_ns("0e999"), 0);
  EXPECT_EQ(parse_ns("5e-999"), 0);
}

TEST(DecimalSeconds, RoundTheTenthDecimal) {
  EXPECT_EQ(parse_ns("0.0000000014"), 1);
  EXPECT_EQ(parse_ns("0.0000000015"), 2);
  EXPECT_EQ(parse_ns("-0.0000000005"), -1);
  EXPECT_EQ(parse_ns("0.00000000049"), 0);
}

TEST(DecimalSeconds, RefuseWhatIsNoTime) {
  for (const char* text : {"", ".", "-", "abc", "1.2.3", "1e", "1e+", "1e5000", "nan", "inf", "0x10", "1 ",
                           "1s", "9223372036.854775808", "1e18"}) {
    EXPECT_EQ(parse_ns(text), std::nullopt) << text;
  }
  EXPECT_EQ(parse_ns("9223372036.854775807"), std::numeric_limits<std::int64_t>::max());
}

TEST(DecimalSeconds, FormatAndParseAreInverse) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const auto time_ns = static_cast<std::int64_t>(random() >> (1 + random() % 62)) * (i % 2 == 0 ? 1 : -1);
    const auto text = format_decimal_seconds(host_time_from_ns(time_ns));
    ASSERT_EQ(parse_ns(text), time_ns) << text;
  }
  EXPECT_EQ(format_decimal_seconds(HostTime::min()), "-9223372036.854775808");
}

std::vector<StampedPose> make_poses(int count) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0.0, 10.0);
  std::vector<StampedPose> poses;
  for (int i = 0; i < count; ++i) {
    StampedPose pose;
    pose.stamp = host_time_from_ns(1'700'000'000'000'000'001 + i * std::int64_t{33'333'333});
    pose.world_from_body.rotation =
        Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
    pose.world_from_body.translation_m = {normal(random), normal(random), normal(random)};
    poses.push_back(pose);
  }
  return poses;
}

TEST(Tum, ReadsWhatItWrote) {
  const test::TempDir folder;
  const auto poses = make_poses(100);
  ASSERT_TRUE(write_tum(folder / "a.tum", poses));
  const auto read = read_tum(folder / "a.tum");
  ASSERT_TRUE(read) << read.error().context;
  ASSERT_EQ(read->size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ((*read)[i].stamp, poses[i].stamp);
    EXPECT_EQ((*read)[i].world_from_body.translation_m, poses[i].world_from_body.translation_m);
    EXPECT_TRUE((*read)[i].world_from_body.rotation.coeffs().isApprox(
        poses[i].world_from_body.rotation.coeffs(), 1e-15));
  }
}

TEST(Tum, AcceptsCommentsBlankLinesAndWindowsLines) {
  const auto poses = parse_tum("# time x y z\n\n 1.5 1 2 3 0 0 0 1 \r\n2,1,2,3,0,0,0.7071,0.7071", "x");
  ASSERT_TRUE(poses) << poses.error().context;
  ASSERT_EQ(poses->size(), 2U);
  EXPECT_NEAR(poses->back().world_from_body.rotation.norm(), 1.0, 1e-15);
  EXPECT_TRUE(parse_tum("", "x").value().empty());
}

TEST(Tum, ErrorsNameFileAndLine) {
  EXPECT_THAT(parse_tum("1 1 2 3 0 0 0 1\n2 1 2 3 0 0 0\n", "a.tum").error().context,
              HasSubstr("a.tum:2: expected 8"));
  EXPECT_THAT(parse_tum("\n#\n1 1 2 x3 0 0 0 1\n", "a.tum").error().context,
              HasSubstr("a.tum:3: 'x3' is not a finite number"));
  EXPECT_THAT(parse_tum("1 1 2 3 0 0 0 2\n", "a.tum").error().context, HasSubstr("a.tum:1: the quaternion"));
  EXPECT_THAT(parse_tum("now 1 2 3 0 0 0 1\n", "a.tum").error().context, HasSubstr("a.tum:1: the time"));
  EXPECT_FALSE(parse_tum("1 nan 2 3 0 0 0 1\n", "a.tum"));
  EXPECT_FALSE(parse_tum("1 1e999 2 3 0 0 0 1\n", "a.tum"));
  EXPECT_FALSE(parse_tum("1 1 2 3 0 0 0 1 9\n", "a.tum"));
  EXPECT_EQ(read_tum("/nonexistent.tum").error().code, Errc::kNotFound);
}

TEST(Kitti, ReadsWhatItWrote) {
  const test::TempDir folder;
  std::vector<geometry::RigidTransform> poses;
  for (const auto& pose : make_poses(50)) poses.push_back(pose.world_from_body);
  ASSERT_TRUE(write_kitti(folder / "00.txt", poses));
  const auto read = read_kitti(folder / "00.txt");
  ASSERT_TRUE(read) << read.error().context;
  ASSERT_EQ(read->size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_TRUE((*read)[i].matrix().isApprox(poses[i].matrix(), 1e-12));
  }
}

TEST(Kitti, RefusesWhatIsNoRotation) {
  EXPECT_TRUE(parse_kitti("1 0 0 5 0 1 0 6 0 0 1 7\n", "k"));
  EXPECT_THAT(parse_kitti("1 0 0 5 0 1 0 6 0 0 -1 7\n", "k").error().context,
              HasSubstr("k:1: the first three"));
  EXPECT_FALSE(parse_kitti("2 0 0 5 0 1 0 6 0 0 1 7\n", "k"));
  EXPECT_THAT(parse_kitti("1 0 0 5\n", "k").error().context, HasSubstr("k:1: expected 12"));
}

TEST(Kitti, ReadsTimes) {
  const test::TempDir folder;
  ASSERT_TRUE(write_file_atomically(folder / "times.txt", "0.000000e+00\n1.036224e-01\n"));
  const auto times = read_times(folder / "times.txt");
  ASSERT_TRUE(times);
  EXPECT_EQ(to_ns(times->at(1)), 103'622'400);
  ASSERT_TRUE(write_file_atomically(folder / "bad.txt", "0.0\n1 2\n"));
  EXPECT_THAT(read_times(folder / "bad.txt").error().context, HasSubstr("bad.txt:2:"));
}

}  // namespace
}  // namespace edgesplat::io
