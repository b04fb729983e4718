// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/group_builder.hpp"
#include "test/robot/sync/stream_fixture.hpp"

#include <gtest/gtest.h>

namespace edgesplat::sync {
namespace {

sensor::LidarScan scan_at(std::int64_t stamp_ns, bool timed = false) {
  sensor::LidarScan scan;
  scan.stamp = sensor_time_from_ns(stamp_ns);
  scan.arrival = host_time_from_ns(stamp_ns);
  scan.has_point_times = timed;
  for (int i = 0; i < 10; ++i) {
    sensor::LidarPoint point;
    point.p_in_lidar_m.x() = static_cast<float>(i);
    point.offset_ns = timed ? static_cast<std::int32_t>(i * 10 * kMs) : 0;
    scan.points.push_back(point);
  }
  return scan;
}

std::vector<MeasureGroup> all_groups(GroupBuilder& builder, const std::vector<sensor::Measurement>& all) {
  std::vector<MeasureGroup> groups;
  for (const auto& measurement : all)
    for (auto& group : builder.push(measurement)) groups.push_back(std::move(group));
  for (auto& group : builder.flush()) groups.push_back(std::move(group));
  return groups;
}

TEST(ScanGroups, OneGroupAScanWithTheNearestImage) {
  const StreamOptions options;
  std::vector<sensor::Measurement> all;
  for (std::uint32_t i = 0; i < 10; ++i) {
    const std::int64_t t = options.start_ns + i * 100 * kMs;
    all.push_back(scan_at(t));
    if (i == 4) continue;                                              // a lost image
    all.push_back(frame_at(options, t + (i == 6 ? 30 : 5) * kMs, i));  // number 6 is too far away
  }
  GroupBuilder builder({}, rig_with(false, true));
  const auto groups = all_groups(builder, all);
  ASSERT_EQ(groups.size(), 10U);
  for (std::uint32_t i = 0; i < 10; ++i) {
    EXPECT_EQ(to_ns(groups[i].end), options.start_ns + i * 100 * kMs);
    EXPECT_EQ(groups[i].points.size(), 10U);
    EXPECT_FALSE(groups[i].has_point_times);
    EXPECT_EQ(groups[i].points.front().before_end_ns, 0);
    if (i > 0) {
      EXPECT_EQ(groups[i].begin, groups[i - 1].end);
    }
    EXPECT_EQ(groups[i].image.has_value(), i != 4 && i != 6) << i;
    if (groups[i].image) {
      EXPECT_EQ(groups[i].image->sequence, i);
    }
  }
  EXPECT_EQ(builder.counters().unused_images, 1U);
  EXPECT_EQ(builder.counters().groups_without_image, 2U);
}

TEST(ScanGroups, WithoutACameraAScanLeavesAtOnce) {
  GroupBuilder builder({}, rig_with(false, false));
  for (std::int64_t i = 1; i < 5; ++i) EXPECT_EQ(builder.push(scan_at(i * 100 * kMs)).size(), 1U);
  EXPECT_TRUE(builder.flush().empty());
}

TEST(ScanGroups, ImageBeforeItsScanIsFound) {
  const StreamOptions options;
  std::vector<sensor::Measurement> all;
  for (std::uint32_t i = 0; i < 5; ++i) {
    const std::int64_t t = options.start_ns + i * 100 * kMs;
    all.push_back(frame_at(options, t - 8 * kMs, i));
    all.push_back(scan_at(t));
  }
  GroupBuilder builder({}, rig_with(false, true));
  const auto groups = all_groups(builder, all);
  ASSERT_EQ(groups.size(), 5U);
  for (const MeasureGroup& group : groups) EXPECT_TRUE(group.image.has_value());
  EXPECT_EQ(builder.counters().unused_images, 0U);
}

TEST(ScanGroups, PointTimesCountBackFromTheLastRay) {
  GroupBuilder builder({}, rig_with(false, false));
  const auto groups = builder.push(scan_at(1000 * kMs, true));
  ASSERT_EQ(groups.size(), 1U);
  EXPECT_EQ(to_ns(groups[0].end), 1090 * kMs);
  EXPECT_TRUE(groups[0].has_point_times);
  EXPECT_EQ(groups[0].points.front().before_end_ns, 90 * kMs);
  EXPECT_EQ(groups[0].points.back().before_end_ns, 0);
}

TEST(ScanGroups, BracketsWithImuAndMakesNoGroupsInBetween) {
  StreamOptions options;
  options.start_ns = 1000 * kMs;
  std::vector<sensor::Measurement> all;
  for (std::int64_t ms = 0; ms < 1000; ++ms) {
    const std::int64_t t = options.start_ns + ms * kMs;
    if (ms % 5 == 2) all.push_back(imu_at(options, t));
    if (ms % 100 == 0) all.push_back(scan_at(t));
  }
  GroupBuilder builder({}, rig_with(true, false));
  const auto groups = all_groups(builder, all);
  ASSERT_EQ(groups.size(), 10U);
  for (std::size_t i = 2; i < groups.size(); ++i) {
    EXPECT_LE(groups[i].imu.front().stamp, groups[i].begin);
    EXPECT_GE(groups[i].imu.back().stamp, groups[i].end);
    EXPECT_EQ(groups[i].imu.size(), 22U);
  }
}

TEST(ScanGroups, ScansOutOfOrderAreCounted) {
  GroupBuilder builder({}, rig_with(false, false));
  EXPECT_EQ(builder.push(scan_at(200 * kMs)).size(), 1U);
  EXPECT_TRUE(builder.push(scan_at(100 * kMs)).empty());
  EXPECT_EQ(builder.counters().late_scans, 1U);
  EXPECT_EQ(builder.counters().late_points, 10U);
}

}  // namespace
}  // namespace edgesplat::sync
