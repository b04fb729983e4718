// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/group_builder.hpp"

#include "test/robot/sync/stream_fixture.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <tuple>

namespace edgesplat::sync {
namespace {

struct Outcome {
  std::vector<MeasureGroup> groups;
  GroupCounters counters;
};

Outcome run(const std::vector<Timed>& all, const sensor::Rig& rig, const GroupBuilderConfig& config = {}) {
  Outcome result;
  GroupBuilder builder(config, rig);
  const auto keep = [&](std::vector<MeasureGroup> groups) {
    for (MeasureGroup& group : groups) result.groups.push_back(std::move(group));
  };
  for (const Timed& timed : all) keep(builder.push(arrived(timed)));
  keep(builder.flush());
  result.counters = builder.counters();
  return result;
}

/// What each group holds, comparable between runs.
std::vector<std::tuple<std::int64_t, std::int64_t, std::vector<float>, std::size_t, bool>> summary(
    const Outcome& run) {
  std::vector<std::tuple<std::int64_t, std::int64_t, std::vector<float>, std::size_t, bool>> out;
  for (const MeasureGroup& group : run.groups) {
    std::vector<float> numbers;
    numbers.reserve(group.points.size());
    for (const GroupPoint& point : group.points) numbers.push_back(point.p_in_lidar_m.x());
    out.emplace_back(to_ns(group.begin), to_ns(group.end), numbers, group.imu.size(),
                     group.image.has_value());
  }
  return out;
}

/// The promises that hold whatever happens: groups in order, points inside, each point once.
void expect_sound(const Outcome& run, std::size_t points_in) {
  std::set<float> seen;
  for (std::size_t i = 0; i < run.groups.size(); ++i) {
    const MeasureGroup& group = run.groups[i];
    EXPECT_LT(group.begin, group.end);
    if (i > 0) {
      EXPECT_GE(group.begin, run.groups[i - 1].end);
    }
    std::int32_t older = std::numeric_limits<std::int32_t>::max();
    for (const GroupPoint& point : group.points) {
      EXPECT_TRUE(seen.insert(point.p_in_lidar_m.x()).second) << "a point came twice";
      EXPECT_GE(point.before_end_ns, 0);
      EXPECT_LT(point.before_end_ns, (group.end - group.begin).count());
      EXPECT_LE(point.before_end_ns, older);
      older = point.before_end_ns;
    }
  }
  EXPECT_EQ(seen.size() + run.counters.late_points + run.counters.overflow_points, points_in);
}

std::size_t count_points(const std::vector<Timed>& all) {
  std::size_t points = 0;
  for (const Timed& timed : all)
    if (const auto* packet = std::get_if<sensor::LidarPacket>(&timed.measurement))
      points += packet->points.size();
  return points;
}

TEST(GroupBuilder, CutsAtImagesAndBracketsWithImu) {
  const StreamOptions options;
  const auto all = make_stream(options);
  const Outcome result = run(all, rig_with(true, true));
  expect_sound(result, count_points(all));
  ASSERT_EQ(result.groups.size(), 21U);  // 20 images and what came after the last of them
  for (std::size_t i = 0; i < 20; ++i) {
    const MeasureGroup& group = result.groups[i];
    ASSERT_TRUE(group.image.has_value());
    EXPECT_EQ(group.image->sequence, i);
    EXPECT_EQ(to_ns(group.end), options.start_ns + (37 + 100 * static_cast<std::int64_t>(i)) * kMs);
    ASSERT_GE(group.imu.size(), 2U);
    EXPECT_GE(group.imu.back().stamp, group.end);
    EXPECT_LT(group.imu[group.imu.size() - 2].stamp, group.end);
    if (i > 0) {
      EXPECT_LE(group.imu.front().stamp, group.begin);
      EXPECT_GT(group.imu[1].stamp, group.begin);
      EXPECT_EQ(group.points.size(), 100U);
    }
  }
  EXPECT_EQ(result.counters.groups_without_imu, 1U);  // the last: nothing after its end
  EXPECT_EQ(result.counters.late_points + result.counters.late_imu + result.counters.late_images, 0U);
}

TEST(GroupBuilder, CutsPeriodicallyWithoutACamera) {
  StreamOptions options;
  options.camera = false;
  options.length_ms = 1000;
  const auto all = make_stream(options);
  const Outcome result = run(all, rig_with(true, false));
  expect_sound(result, count_points(all));
  ASSERT_EQ(result.groups.size(), 10U);
  for (std::size_t i = 0; i + 1 < result.groups.size(); ++i)
    EXPECT_EQ(result.groups[i].end - result.groups[i].begin, nanoseconds(100 * kMs));
  EXPECT_EQ(result.counters.groups_without_image, 0U);
}

TEST(GroupBuilder, DoesNotDependOnHowArrivalsInterleave) {
  for (const bool camera : {true, false}) {
    StreamOptions options;
    options.camera = camera;
    auto in_order = make_stream(options);
    const Outcome expected = run(in_order, rig_with(true, camera));
    for (std::uint32_t seed = 1; seed <= 30; ++seed) {
      auto all = make_stream(options);
      delay_randomly(all, 90, seed);
      const Outcome result = run(all, rig_with(true, camera));
      expect_sound(result, count_points(all));
      ASSERT_EQ(summary(result), summary(expected)) << "seed " << seed;
    }
  }
}

TEST(GroupBuilder, GroupsLeaveAsSoonAsBothSensorsPassed) {
  const auto all = make_stream({});
  GroupBuilder builder({}, rig_with(true, true));
  for (const Timed& timed : all) {
    for (const MeasureGroup& group : builder.push(arrived(timed)))
      EXPECT_LT(timed.arrival_ns - to_ns(group.end), 10 * kMs);
  }
}

TEST(GroupBuilder, GoesOnWithoutTheCameraAndTakesItBack) {
  const StreamOptions options;
  std::vector<Timed> all;
  for (const Timed& timed : make_stream(options)) {
    const auto* frame = std::get_if<sensor::CameraFrame>(&timed.measurement);
    if (frame != nullptr && frame->sequence >= 5 && frame->sequence < 14) continue;
    all.push_back(timed);
  }
  std::vector<std::size_t> with_image;
  const Outcome expected = run(all, rig_with(true, true));
  expect_sound(expected, count_points(all));
  for (const MeasureGroup& group : expected.groups)
    EXPECT_LE(group.end - group.begin, nanoseconds(100 * kMs)) << "an outage of the camera is no event";
  EXPECT_EQ(expected.counters.late_images, 0U);
  EXPECT_EQ(std::count_if(expected.groups.begin(), expected.groups.end(),
                          [](const MeasureGroup& g) { return g.image.has_value(); }),
            11);
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    auto delayed = all;
    delay_randomly(delayed, 60, seed);
    ASSERT_EQ(summary(run(delayed, rig_with(true, true))), summary(expected)) << "seed " << seed;
  }
}

TEST(GroupBuilder, OneLostImageMakesOneLongGroup) {
  std::vector<Timed> all;
  for (const Timed& timed : make_stream({})) {
    const auto* frame = std::get_if<sensor::CameraFrame>(&timed.measurement);
    if (frame == nullptr || frame->sequence != 5) all.push_back(timed);
  }
  const Outcome result = run(all, rig_with(true, true));
  EXPECT_EQ(result.groups[5].end - result.groups[5].begin, nanoseconds(200 * kMs));
}

TEST(GroupBuilder, GoesOnWithoutLidarOrImu) {
  for (const std::size_t silent : {std::size_t{0}, std::size_t{1}}) {  // index of ImuSample, LidarPacket
    StreamOptions options;
    options.length_ms = 3000;
    std::vector<Timed> all;
    for (const Timed& timed : make_stream(options)) {
      const std::int64_t ms = (timed.arrival_ns - options.start_ns) / kMs;
      if (timed.measurement.index() != silent || ms < 500 || ms > 1800) all.push_back(timed);
    }
    const Outcome result = run(all, rig_with(true, true));
    expect_sound(result, count_points(all));
    EXPECT_EQ(result.groups.size(), 31U);
    EXPECT_EQ(result.counters.late_points, 0U);
    if (silent == 1) {
      EXPECT_GE(result.counters.groups_without_points, 11U);
    }
    if (silent == 0) {
      EXPECT_GE(result.counters.groups_without_imu, 10U);
    }
  }
}

TEST(GroupBuilder, APauseOfAllSensorsMakesNoEmptyGroups) {
  StreamOptions options;
  auto all = make_stream(options);
  StreamOptions after = options;
  after.start_ns += 3'600'000 * kMs;
  for (const Timed& timed : make_stream(after)) all.push_back(timed);
  const Outcome result = run(all, rig_with(true, true));
  EXPECT_LE(result.groups.size(), 45U);
  EXPECT_LE(result.counters.groups_without_points, 1U);
}

TEST(GroupBuilder, CountsPointsThatComeAfterTheirGroup) {
  StreamOptions options;
  options.camera = false;
  auto all = make_stream(options);
  int number = 1'000'000;
  const Timed stray{all.back().arrival_ns, packet_at(options, options.start_ns + 500 * kMs, number)};
  all.push_back(stray);
  const Outcome result = run(all, rig_with(true, false));
  expect_sound(result, count_points(all));
  EXPECT_EQ(result.counters.late_points, 5U);
}

TEST(GroupBuilder, FreeRunningClocksGiveTheSameGroupsOnHostTime) {
  StreamOptions options;
  options.length_ms = 4000;
  options.source = sensor::StampSource::kFreeRunning;
  auto all = make_stream(options);
  constexpr std::int64_t kLidarOff_ns = 77'000 * kMs;  // the device's clock against the host's
  for (Timed& timed : all) {
    timed.arrival_ns += std::holds_alternative<sensor::CameraFrame>(timed.measurement) ? 2 * kMs : kMs / 5;
    if (auto* frame = std::get_if<sensor::CameraFrame>(&timed.measurement))
      frame->stamp -= nanoseconds(options.start_ns);
    if (auto* packet = std::get_if<sensor::LidarPacket>(&timed.measurement))
      packet->stamp -= nanoseconds(kLidarOff_ns);
    if (auto* sample = std::get_if<sensor::ImuSample>(&timed.measurement))
      sample->stamp -= nanoseconds(kLidarOff_ns);
  }
  const auto earlier = [](const Timed& a, const Timed& b) { return a.arrival_ns < b.arrival_ns; };
  std::stable_sort(all.begin(), all.end(), earlier);
  const Outcome result = run(all, rig_with(true, true));
  expect_sound(result, count_points(all));
  EXPECT_EQ(result.counters.late_points, 0U);
  EXPECT_EQ(result.counters.clock_changes, 0U);
  ASSERT_EQ(result.groups.size(), 41U);
  EXPECT_NEAR(static_cast<double>(to_ns(result.groups[30].end)),
              static_cast<double>(options.start_ns + 3037 * kMs), 2.5e6);  // but for the constant latency
}

TEST(GroupBuilder, SurvivesAClockThatJumps) {
  for (const auto source : {sensor::StampSource::kFreeRunning, sensor::StampSource::kPtp}) {
    StreamOptions options;
    options.source = source;
    options.length_ms = 4000;
    auto all = make_stream(options);
    for (Timed& timed : all) {
      if (timed.arrival_ns < options.start_ns + 2000 * kMs) continue;
      std::visit([](auto& one) { one.stamp += nanoseconds(500'000 * kMs); }, timed.measurement);
    }
    const Outcome result = run(all, rig_with(true, true));
    expect_sound(result, count_points(all));
    EXPECT_GE(result.counters.clock_changes, 1U);
    EXPECT_LE(result.counters.late_points, 25U);
    EXPECT_LE(to_ns(result.groups.back().end), options.start_ns + 4020 * kMs) << "host time never jumps";
    EXPECT_GE(result.groups.size(), 38U);
  }
}

TEST(GroupBuilder, BuffersStayBounded) {
  GroupBuilderConfig config;
  config.max_images = 4;
  StreamOptions options;
  GroupBuilder builder(config, rig_with(true, true));
  for (std::uint32_t i = 0; i < 100; ++i)  // a camera alone
    EXPECT_TRUE(builder.push(frame_at(options, options.start_ns + i * 100 * kMs, i)).empty());
  EXPECT_EQ(builder.counters().overflow_images, 96U);

  GroupBuilderConfig small;
  small.max_points = 50;
  const auto all = make_stream(options);
  const Outcome result = run(all, rig_with(true, true), small);
  expect_sound(result, count_points(all));
  EXPECT_GT(result.counters.overflow_points, 0U);
}

TEST(GroupBuilder, CountsWhatTheRigDoesNotHave) {
  const auto all = make_stream({});
  const Outcome result = run(all, rig_with(false, false));
  for (const MeasureGroup& group : result.groups) {
    EXPECT_TRUE(group.imu.empty());
    EXPECT_FALSE(group.image.has_value());
  }
  EXPECT_EQ(result.counters.bad_values, 400U + 20U);
}

}  // namespace
}  // namespace edgesplat::sync
