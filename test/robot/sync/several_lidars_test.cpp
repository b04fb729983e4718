// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Several LiDARs with clocks of their own make one scan, whatever becomes of one of them.
#include "robot/sync/group_builder.hpp"
#include "test/robot/sync/stream_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>

namespace edgesplat::sync {
namespace {

using sensor::StampSource;

sensor::Rig rig_of_two(bool camera = false) {
  sensor::Rig rig = rig_with(true, camera);
  rig.more_lidars.emplace_back();
  return rig;
}

constexpr int kFirstOfSecond = 1'000'000;  // points of the second LiDAR are numbered from here

/// How a device differs from truth: its stamps, and whether what is measured at `ms` arrives at all, and how
/// late.
struct Unit {
  std::function<std::int64_t(std::int64_t)> stamp_ns = [](std::int64_t true_ns) { return true_ns; };
  StampSource source = StampSource::kPtp;
  std::function<bool(std::int64_t)> is_heard = [](std::int64_t) { return true; };
  std::int64_t latency_ms = 0;
};

/// The made-up robot with two LiDARs, the second one's packets 2 ms after the first one's. Sorted by arrival.
std::vector<Timed> two_lidars(const StreamOptions& options, const Unit& first, const Unit& second) {
  std::vector<Timed> all;
  for (Timed& timed : make_stream(options)) {
    const std::int64_t ms = (timed.arrival_ns - options.start_ns) / kMs;
    if (std::holds_alternative<sensor::CameraFrame>(timed.measurement)) {
      all.push_back(std::move(timed));
      continue;
    }
    auto* packet = std::get_if<sensor::LidarPacket>(&timed.measurement);
    if (packet != nullptr) {
      Timed other = timed;
      auto& points = std::get<sensor::LidarPacket>(other.measurement);
      points.unit = 1;
      for (sensor::LidarPoint& point : points.points) point.p_in_lidar_m.x() += kFirstOfSecond;
      const std::int64_t true_ns = to_ns(points.stamp) + 2 * kMs;
      points.stamp = sensor_time_from_ns(second.stamp_ns(true_ns));
      points.stamp_source = second.source;
      other.arrival_ns += (2 + second.latency_ms) * kMs;
      if (second.is_heard(ms)) all.push_back(std::move(other));
    }
    std::visit(
        [&](auto& one) {
          one.stamp = sensor_time_from_ns(first.stamp_ns(to_ns(one.stamp)));
          if constexpr (requires { one.stamp_source; }) one.stamp_source = first.source;
        },
        timed.measurement);
    timed.arrival_ns += first.latency_ms * kMs;
    if (packet == nullptr || first.is_heard(ms)) all.push_back(std::move(timed));
  }
  std::ranges::stable_sort(all, {}, &Timed::arrival_ns);
  return all;
}

struct Outcome {
  std::vector<MeasureGroup> groups;
  std::vector<std::int64_t> left_ms;  ///< arrival of what completed each group
  GroupCounters counters;
};

Outcome run(const std::vector<Timed>& all, const sensor::Rig& rig, const StreamOptions& options = {}) {
  Outcome result;
  GroupBuilder builder({}, rig);
  const auto keep = [&](std::vector<MeasureGroup> groups, std::int64_t at_ns) {
    for (MeasureGroup& group : groups) {
      result.groups.push_back(std::move(group));
      result.left_ms.push_back((at_ns - options.start_ns) / kMs);
    }
  };
  for (const Timed& timed : all) keep(builder.push(arrived(timed)), timed.arrival_ns);
  keep(builder.flush(), all.back().arrival_ns);
  result.counters = builder.counters();
  return result;
}

/// Groups in order, points in time order and inside, each once, with its unit; how many came out of each.
std::map<std::size_t, std::size_t> expect_sound(const Outcome& run) {
  std::map<std::size_t, std::size_t> count;
  std::set<float> seen;
  for (std::size_t i = 0; i < run.groups.size(); ++i) {
    const MeasureGroup& group = run.groups[i];
    EXPECT_LT(group.begin, group.end);
    if (i > 0) {
      EXPECT_EQ(group.begin, run.groups[i - 1].end);
    }
    std::int32_t older = std::numeric_limits<std::int32_t>::max();
    for (const GroupPoint& point : group.points) {
      EXPECT_TRUE(seen.insert(point.p_in_lidar_m.x()).second) << "a point came twice";
      EXPECT_EQ(point.unit, point.p_in_lidar_m.x() >= kFirstOfSecond ? 1 : 0);
      EXPECT_GE(point.before_end_ns, 0);
      EXPECT_LT(point.before_end_ns, (group.end - group.begin).count());
      EXPECT_LE(point.before_end_ns, older) << "not in time order";
      older = point.before_end_ns;
      ++count[point.unit];
    }
  }
  return count;
}

/// The largest error of a point's time, in ns, against when the made-up robot fired it.
std::int64_t worst_error_ns(const Outcome& run, const StreamOptions& options, std::size_t from_group = 0) {
  std::int64_t worst = 0;
  for (std::size_t i = from_group; i < run.groups.size(); ++i) {
    for (const GroupPoint& point : run.groups[i].points) {
      const int number = static_cast<int>(point.p_in_lidar_m.x()) % kFirstOfSecond;
      const std::int64_t fired_ns =
          options.start_ns + (number / 5 * 5 + number % 5 + (point.unit == 1 ? 2 : 0)) * kMs;
      worst = std::max(worst, std::abs(to_ns(run.groups[i].end) - point.before_end_ns - fired_ns));
    }
  }
  return worst;
}

TEST(SeveralLidars, MakeOneScanInTimeOrder) {
  const StreamOptions options;
  const Outcome result = run(two_lidars(options, {}, {}), rig_of_two(true));
  const auto count = expect_sound(result);
  EXPECT_EQ(count.at(0), 2000U);
  EXPECT_EQ(count.at(1), 2000U);
  EXPECT_EQ(worst_error_ns(result, options), 0);
  EXPECT_EQ(result.counters.lidars.at(1).points, 2000U);
  EXPECT_EQ(result.counters.lidars.at(1).outs, 0U);
  for (std::size_t i = 1; i + 1 < result.groups.size(); ++i) {
    const auto& points = result.groups[i].points;
    EXPECT_EQ(points.size(), 200U);
    EXPECT_NEAR(static_cast<double>(std::ranges::count(points, 1, &GroupPoint::unit)), 100.0, 5.0);
  }
}

TEST(SeveralLidars, DoNotDependOnHowArrivalsInterleave) {
  const StreamOptions options;
  const auto numbers = [](const Outcome& run) {
    std::vector<std::pair<std::int64_t, std::vector<float>>> out;
    for (const MeasureGroup& group : run.groups) {
      out.emplace_back(to_ns(group.end), std::vector<float>());
      for (const GroupPoint& point : group.points) out.back().second.push_back(point.p_in_lidar_m.x());
    }
    return out;
  };
  Unit slow;
  slow.latency_ms = 80;
  const auto plain = numbers(run(two_lidars(options, {}, {}), rig_of_two()));
  EXPECT_EQ(numbers(run(two_lidars(options, {}, slow), rig_of_two())), plain);
  EXPECT_EQ(numbers(run(two_lidars(options, slow, {}), rig_of_two())), plain);
}

TEST(SeveralLidars, OneThatIsPulledIsWaitedForOnceAndTakenBack) {
  StreamOptions options;
  options.length_ms = 6000;
  const auto pulled = [](std::int64_t ms) { return ms < 2000 || ms >= 4000; };
  for (const std::size_t which : {0U, 1U}) {
    Unit first, second;
    (which == 0 ? first : second).is_heard = pulled;
    const Outcome result = run(two_lidars(options, first, second), rig_of_two(), options);
    const auto count = expect_sound(result);
    EXPECT_EQ(count.at(1 - which), 6000U) << "the other one loses nothing";
    EXPECT_NEAR(static_cast<double>(count.at(which)), 4000.0, 5.0);
    EXPECT_EQ(result.counters.late_points, 0U);
    EXPECT_EQ(result.counters.lidars.at(which).outs, 1U);
    EXPECT_EQ(result.counters.lidars.at(1 - which).outs, 0U);
    EXPECT_FALSE(result.counters.lidars.at(which).is_out);
    // Groups wait for it half a second once, then leave at once: with it, without it, and with it again.
    for (std::size_t i = 0; i + 1 < result.groups.size(); ++i) {
      const std::int64_t ended_ms = (to_ns(result.groups[i].end) - options.start_ns) / kMs;
      const bool waits = ended_ms > 1900 && ended_ms <= 2500;
      EXPECT_LE(result.left_ms[i] - ended_ms, waits ? 620 : 20) << ended_ms;
    }
    EXPECT_EQ(worst_error_ns(result, options), 0);
  }
}

TEST(SeveralLidars, OneThatIsNeverHeardHoldsNobodyUp) {
  const StreamOptions options;
  Unit dead;
  dead.is_heard = [](std::int64_t) { return false; };
  const Outcome result = run(two_lidars(options, {}, dead), rig_of_two(), options);
  EXPECT_EQ(expect_sound(result).at(0), 2000U);
  EXPECT_EQ(result.counters.lidars.at(1).outs, 1U);
  EXPECT_TRUE(result.counters.lidars.at(1).is_out);
  EXPECT_LE(result.left_ms.front(), 620);
}

TEST(SeveralLidars, FreeClocksOfTheirOwnAreFittedEachByItself) {
  StreamOptions options;
  options.length_ms = 20'000;
  Unit first, second;
  first.source = second.source = StampSource::kFreeRunning;
  first.stamp_ns = [&](std::int64_t t) { return 7 * kMs + (t - options.start_ns) / 1'000'000 * 1'000'040; };
  second.stamp_ns = [&](std::int64_t t) { return 900 * kMs + (t - options.start_ns) / 1'000'000 * 999'950; };
  const Outcome result = run(two_lidars(options, first, second), rig_of_two());
  const auto count = expect_sound(result);
  EXPECT_EQ(count.at(0) + count.at(1) + result.counters.late_points, 40'000U);
  // 4 ms after the first ray the packets leave: that latency cannot be seen, and is the same for both.
  EXPECT_LT(worst_error_ns(result, options, 50), 4'100'000);
  EXPECT_EQ(result.counters.clock_changes, 0U);
}

TEST(SeveralLidars, AFreeOneJoinsTheDisciplinedOne) {
  StreamOptions options;
  options.length_ms = 10'000;
  Unit free;
  free.source = StampSource::kFreeRunning;
  free.stamp_ns = [&](std::int64_t t) { return 42 + (t - options.start_ns) / 1000 * 1000; };
  const Outcome result = run(two_lidars(options, {}, free), rig_of_two());
  EXPECT_EQ(expect_sound(result).at(1), 10'000U);
  EXPECT_LT(worst_error_ns(result, options, 20), 10'000);
}

TEST(SeveralLidars, OneOfAnotherTimeScaleDoesNotPassTheOthersBy) {
  StreamOptions options;
  options.length_ms = 4000;
  for (const std::int64_t off_ns : {37'000 * kMs, -37'000 * kMs}) {
    Unit other;  // says PTP, but its master is on TAI
    other.stamp_ns = [off_ns](std::int64_t t) { return t + off_ns; };
    const Outcome result = run(two_lidars(options, {}, other), rig_of_two());
    const auto count = expect_sound(result);
    EXPECT_EQ(count.at(0), 4000U);
    EXPECT_EQ(count.at(1), 4000U);
    EXPECT_EQ(result.counters.clock_lies, 1U);
    EXPECT_LT(worst_error_ns(result, options), 10'000);
  }
}

TEST(SeveralLidars, AStepOfOneClockCostsTheOthersNothing) {
  StreamOptions options;
  options.length_ms = 4000;
  Unit stepping;
  stepping.stamp_ns = [&](std::int64_t t) {
    return t + (t - options.start_ns >= 2000 * kMs ? 700 * kMs : 0);
  };
  const Outcome result = run(two_lidars(options, {}, stepping), rig_of_two());
  const auto count = expect_sound(result);
  EXPECT_EQ(count.at(0), 4000U);
  EXPECT_EQ(count.at(1), 4000U);
  EXPECT_GE(result.counters.clock_changes, 1U);
  EXPECT_EQ(result.counters.late_points, 0U);
}

TEST(SeveralLidars, PointsOfOneThatTheRigDoesNotHaveAreCounted) {
  StreamOptions options;
  options.camera = false;
  const Outcome result = run(two_lidars(options, {}, {}), rig_with(true, false));
  EXPECT_EQ(expect_sound(result).size(), 1U);
  EXPECT_EQ(result.counters.bad_values, 400U);
}

}  // namespace
}  // namespace edgesplat::sync
