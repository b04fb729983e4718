// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/offload/offload_control.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace edgesplat::offload {
namespace {

using policy::Mode;
using policy::OffloadSetting;
using policy::Reason;

/// A robot in virtual time whose pictures, memory, link and server do as they are told.
class Robot {
 public:
  explicit Robot(OffloadSetting setting) : control_(config(setting), sources(), clock_) {}

  double render_ms = 10.0;
  double memory_bytes = 5e8;
  std::optional<double> bandwidth_bytes_per_s = 1e6;
  double round_trip_ms = 5.0;
  bool server_there = true;
  bool in_step = true;
  std::uint64_t given_up = 0;
  std::vector<std::pair<double, policy::Decision>> changes;  ///< seconds since the start

  void run(double seconds) {
    const double end = t_s_ + seconds;
    for (; t_s_ < end - 1e-9; t_s_ += 0.05) {
      clock_.advance_to(HostTime(from_seconds(100.0 + t_s_)));
      ++tick_;
      control_.on_picture(render_ms);
      if (server_there && tick_ % 4 == 0) control_.on_server_heartbeat(in_step);
      if (tick_ % 10 != 0) continue;
      last = control_.evaluate();
      if (last.decision.changed) changes.emplace_back(t_s_, last.decision);
    }
  }
  [[nodiscard]] Mode mode() const { return last.decision.mode; }
  [[nodiscard]] double now_s() const { return t_s_; }
  OffloadRecord last;

 private:
  static policy::OffloadConfig config(OffloadSetting setting) {
    policy::OffloadConfig config;
    config.setting = setting;
    config.server_timeout_s = 1.5;
    return config;
  }
  OffloadSources sources() {
    OffloadSources sources;
    sources.link = [this] { return link::LinkQuality{bandwidth_bytes_per_s, round_trip_ms, std::nullopt}; };
    sources.counters = [this] {
      link::LinkCounters counters;
      counters[link::index_of(link::Lane::kKeyframe)].messages_given_up = given_up;
      return counters;
    };
    sources.memory_bytes = [this] { return static_cast<std::uint64_t>(memory_bytes); };
    return sources;
  }

  VirtualClock clock_{HostTime(std::chrono::seconds(100))};
  OffloadControl control_;
  double t_s_ = 0.0;
  int tick_ = 0;
};

TEST(OffloadControl, StaysLocalWithHeadroom) {
  Robot robot(OffloadSetting::kAuto);
  robot.run(60);
  EXPECT_EQ(robot.mode(), Mode::kLocal);
  EXPECT_TRUE(robot.changes.empty());
  EXPECT_FALSE(robot.last.bandwidth_matters);
  EXPECT_FALSE(robot.last.offload_wanted);
}

TEST(OffloadControl, LatencyAloneOffloads) {
  Robot robot(OffloadSetting::kAuto);
  robot.run(10);
  robot.render_ms = 40.0;
  robot.run(5);
  EXPECT_EQ(robot.mode(), Mode::kFull);
  ASSERT_EQ(robot.changes.size(), 1U);
  EXPECT_EQ(robot.changes[0].second.reason, Reason::kLatency);
  EXPECT_LE(robot.changes[0].first, 10 + 3.0);
}

TEST(OffloadControl, OneSlowPictureInTwentyIsNotYetLatency) {
  Robot robot(OffloadSetting::kAuto);
  for (int i = 0; i < 30; ++i) {
    robot.render_ms = 200.0;
    robot.run(0.05);
    robot.render_ms = 10.0;
    robot.run(1.95);
  }
  EXPECT_TRUE(robot.changes.empty());
}

TEST(OffloadControl, MemoryAloneOffloads) {
  Robot robot(OffloadSetting::kAuto);
  robot.run(10);
  robot.memory_bytes = 2e9;
  robot.run(5);
  EXPECT_EQ(robot.mode(), Mode::kFull);
  EXPECT_EQ(robot.changes.at(0).second.reason, Reason::kMemory);
}

TEST(OffloadControl, ANarrowLinkPrunesInsteadAndIsWorthMeasuring) {
  Robot robot(OffloadSetting::kAuto);
  robot.bandwidth_bytes_per_s = 20e3;
  robot.render_ms = 40.0;
  robot.run(10);
  EXPECT_EQ(robot.mode(), Mode::kLocal);
  EXPECT_TRUE(robot.last.decision.prune_and_compress);
  EXPECT_TRUE(robot.last.bandwidth_matters);
}

TEST(OffloadControl, ALinkInBetweenGivesLean) {
  Robot robot(OffloadSetting::kAlways);
  robot.bandwidth_bytes_per_s = 150e3;
  robot.run(5);
  EXPECT_EQ(robot.mode(), Mode::kLean);
  EXPECT_TRUE(robot.last.bandwidth_matters);
  robot.bandwidth_bytes_per_s = 1e6;
  robot.run(15);
  EXPECT_EQ(robot.mode(), Mode::kFull);
  EXPECT_FALSE(robot.last.bandwidth_matters);
}

TEST(OffloadControl, AnUnknownLinkIsNeverOffloadedTo) {
  Robot robot(OffloadSetting::kAlways);
  robot.bandwidth_bytes_per_s.reset();
  robot.run(20);
  EXPECT_EQ(robot.mode(), Mode::kLocal);
  EXPECT_TRUE(robot.last.bandwidth_matters);
}

TEST(OffloadControl, ALostServerMeansLocalWithinTwoSecondsAndBackOnlyInStep) {
  for (int phase = 0; phase < 10; ++phase) {  // of the loss within the evaluation's period
    Robot robot(OffloadSetting::kAlways);
    robot.run(15 + 0.05 * phase);
    ASSERT_EQ(robot.mode(), Mode::kFull);
    robot.server_there = false;
    const double lost_s = robot.now_s();
    robot.run(2.0);
    EXPECT_EQ(robot.mode(), Mode::kLocal) << "phase " << phase;
    ASSERT_EQ(robot.changes.size(), 2U);
    EXPECT_EQ(robot.changes[1].second.reason, Reason::kServerLost);
    EXPECT_LE(robot.changes[1].first - lost_s, 2.0);
    robot.run(20);
    robot.server_there = true;
    robot.in_step = false;  // the snapshot is still on its way
    robot.run(20);
    EXPECT_EQ(robot.mode(), Mode::kLocal);
    robot.in_step = true;
    robot.run(3);
    EXPECT_EQ(robot.mode(), Mode::kFull);
  }
}

TEST(OffloadControl, AFailedOffloadGoesLocalAndWaits) {
  Robot robot(OffloadSetting::kAlways);
  robot.run(15);
  robot.given_up = 1;
  robot.run(0.5);
  EXPECT_EQ(robot.mode(), Mode::kLocal);
  EXPECT_EQ(robot.changes.back().second.reason, Reason::kFailed);
  robot.run(5);
  EXPECT_EQ(robot.mode(), Mode::kLocal);
  robot.run(20);
  EXPECT_EQ(robot.mode(), Mode::kFull);
}

TEST(OffloadControl, NeverIsNever) {
  Robot robot(OffloadSetting::kNever);
  robot.render_ms = 100.0;
  robot.memory_bytes = 9e9;
  robot.run(30);
  EXPECT_TRUE(robot.changes.empty());
  EXPECT_FALSE(robot.last.bandwidth_matters);
}

TEST(OffloadControl, SwitchesAtMostOnceInTenSecondsOnTheMean) {
  Robot robot(OffloadSetting::kAlways);
  for (int i = 0; i < 300; ++i) {  // a link that changes every second
    robot.bandwidth_bytes_per_s = i % 2 == 0 ? 1e6 : 100e3;
    robot.run(1);
  }
  EXPECT_LE(robot.changes.size(), 30U);
}

}  // namespace
}  // namespace edgesplat::offload
