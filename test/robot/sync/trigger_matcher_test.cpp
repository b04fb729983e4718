// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/trigger_matcher.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace edgesplat::sync {
namespace {

/// The pulses' times are Unix time, the host's clock began at some other moment.
constexpr nanoseconds kPpsFromHost = std::chrono::seconds(1'700'000'000);

struct Troubles {
  double lose_frame = 0.0;    ///< on the way to the host
  double miss_pulse = 0.0;    ///< by the camera
  double lose_report = 0.0;   ///< of a pulse
  double most_late_s = 0.06;  ///< arrival after the pulse, from 0.02
  double ppm = 0.0;           ///< of the camera's clock
  double from_s = 0.0;        ///< the troubles begin
};

/// A microcontroller that leaves one pulse out every 3.7 s, and a camera that it triggers; what happened in
/// truth beside.
class Bench {
 public:
  Bench(const Troubles& troubles, unsigned seed) : troubles_(troubles), random_(seed) {}

  struct Result {
    int right = 0;
    int wrong = 0;
    int frames = 0;
    int after_lock = 0;  ///< frames that came to the host once it was locked
    int lost = 0;
    int missed = 0;  ///< pulses, once it was locked
  };
  Result run(TriggerMatcher& matcher, double seconds) {
    Result result;
    const auto slots = static_cast<int>(seconds / 0.1);
    std::uint32_t pulse_number = 500, frame_number = 65'500;
    const double offset_s = uniform(0.0, 5.0);
    for (int slot = 0; slot < slots; ++slot) {
      if (slot % 37 == 11) continue;  // the code
      const double t = 100.0 + 0.1 * slot + normal() * 20e-6;
      const bool trouble = 0.1 * slot >= troubles_.from_s;
      const TriggerPulse pulse{pulse_number++, at(t) + kPpsFromHost, at(t + 0.003)};
      if (!(trouble && chance(troubles_.lose_report)))
        matcher_events_.push_back({t + 0.003, pulse, {}, true});
      if (trouble && chance(troubles_.miss_pulse)) {
        missed_at_.push_back(t);
        continue;
      }
      TriggeredFrame frame;
      frame.number = frame_number++;
      frame.stamp = sensor_time_from_ns(std::llround(
          1e9 * (offset_s + (t - 100.0 + 15e-6) * (1.0 + troubles_.ppm * 1e-6) + normal() * 5e-6)));
      const double arrival = t + uniform(0.02, troubles_.most_late_s);
      frame.arrival = at(arrival);
      truth_[frame.number] = pulse.number;
      if (trouble && chance(troubles_.lose_frame)) {
        ++result.lost;
        continue;
      }
      matcher_events_.push_back({std::max(arrival, last_arrival_ + 1e-4), pulse, frame, false});
      last_arrival_ = matcher_events_.back().when;
    }
    std::ranges::stable_sort(matcher_events_, {}, &Event::when);
    double locked_at = 1e18;
    for (const Event& event : matcher_events_) {
      if (event.is_pulse) {
        matcher.add_pulse(event.pulse);
        continue;
      }
      ++result.frames;
      if (matcher.locked()) ++result.after_lock;
      const auto found = matcher.match(event.frame);
      if (matcher.locked()) locked_at = std::min(locked_at, event.when);
      if (found) ++(found->number == truth_.at(event.frame.number) ? result.right : result.wrong);
    }
    for (const double t : missed_at_) result.missed += t > locked_at ? 1 : 0;
    return result;
  }

 private:
  struct Event {
    double when;
    TriggerPulse pulse;
    TriggeredFrame frame;
    bool is_pulse;
  };
  static HostTime at(double seconds) { return host_time_from_ns(std::llround(seconds * 1e9)); }
  double uniform(double a, double b) { return std::uniform_real_distribution(a, b)(random_); }
  double normal() { return std::normal_distribution()(random_); }
  bool chance(double share) { return uniform(0.0, 1.0) < share; }
  Troubles troubles_;
  std::mt19937 random_;
  std::vector<Event> matcher_events_;
  std::map<std::uint32_t, std::uint32_t> truth_;
  std::vector<double> missed_at_;
  double last_arrival_ = 0.0;
};

TEST(TriggerMatcher, WithoutTroubleEveryFrameAfterTheSecondCodeHasItsPulse) {
  TriggerMatcher matcher({});
  const auto result = Bench({}, 1).run(matcher, 60.0);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_EQ(result.right, result.after_lock);
  EXPECT_GT(result.right, 520);  // of 584: 5 s until the second hole
  EXPECT_EQ(matcher.counters().locks, 1U);
  EXPECT_EQ(matcher.counters().slips, 0U);
  EXPECT_EQ(matcher.counters().missed_pulses, 0U);
}

TEST(TriggerMatcher, FramesLaterThanSeveralPeriodsAreNotShifted) {
  TriggerMatcher matcher({});
  const auto result = Bench({.most_late_s = 0.75}, 2).run(matcher, 60.0);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_EQ(result.right, result.after_lock);
}

TEST(TriggerMatcher, ALostFrameIsCountedAndShiftsNothing) {
  TriggerMatcher matcher({});
  const auto result = Bench({.lose_frame = 0.1, .from_s = 15.0}, 3).run(matcher, 120.0);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_EQ(matcher.counters().lost_frames, static_cast<std::uint64_t>(result.lost));
  EXPECT_EQ(result.right, result.after_lock);
}

TEST(TriggerMatcher, APulseThatTheCameraMissedIsCountedAndShiftsNothing) {
  TriggerMatcher matcher({});
  const auto result = Bench({.miss_pulse = 0.02, .from_s = 15.0}, 4).run(matcher, 200.0);
  EXPECT_EQ(result.wrong, 0);
  EXPECT_EQ(result.right, result.after_lock);
  EXPECT_NEAR(static_cast<double>(matcher.counters().missed_pulses), result.missed,
              3.0);  // two in a row count as none
}

class TriggerMatcherProperty : public testing::TestWithParam<unsigned> {};

TEST_P(TriggerMatcherProperty, WhateverGetsLostNoImageIsShifted) {
  std::mt19937 random(GetParam());
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random); };
  for (int round = 0; round < 40; ++round) {
    const Troubles troubles{.lose_frame = uniform(0.0, 0.3),
                            .miss_pulse = uniform(0.0, 0.05),
                            .lose_report = uniform(0.0, 0.2),
                            .most_late_s = uniform(0.03, 0.9),
                            .ppm = uniform(-100.0, 100.0),
                            .from_s = uniform(0.0, 20.0)};
    TriggerMatcher matcher({});
    const auto result = Bench(troubles, static_cast<unsigned>(random())).run(matcher, 120.0);
    EXPECT_EQ(result.wrong, 0) << "round " << round;
    EXPECT_EQ(matcher.counters().slips, 0U) << "round " << round;
    // A frame whose pulse was not reported has none; all others that came once it was locked do.
    EXPECT_EQ(static_cast<std::uint64_t>(result.right) + matcher.counters().unmatched,
              static_cast<std::uint64_t>(result.after_lock))
        << "round " << round;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, TriggerMatcherProperty, testing::Range(1U, 9U));

TEST(TriggerMatcher, ACameraThatBeginsAnewIsLookedForAnew) {
  TriggerMatcher matcher({});
  (void)Bench({}, 5).run(matcher, 30.0);
  ASSERT_TRUE(matcher.locked());
  EXPECT_FALSE(matcher.match({1, sensor_time_from_ns(1), host_time_from_ns(131'000'000'000)}).has_value());
  EXPECT_FALSE(matcher.locked());
}

}  // namespace
}  // namespace edgesplat::sync
