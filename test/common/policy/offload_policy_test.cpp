// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/policy/offload_policy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace edgesplat::policy {
namespace {

constexpr double kPeriodS = 0.5;

/// A link and a load as functions of time, driven through the policy.
struct Trace {
  OffloadConfig config;
  std::function<double(double)> bandwidth_bytes_per_s = [](double) { return 1e6; };
  std::function<double(double)> render_p95_ms = [](double) { return 50.0; };
  std::function<double(double)> memory_bytes = [](double) { return 0.0; };
  std::function<double(double)> round_trip_ms = [](double) { return 10.0; };
  std::function<bool(double)> server_up = [](double) { return true; };

  struct Step {
    double t_s;
    Decision decision;
  };
  [[nodiscard]] std::vector<Step> run(double seconds) const {
    OffloadPolicy policy(config);
    std::vector<Step> steps;
    HostTime last_heartbeat{};
    for (double t_s = 0.0; t_s < seconds; t_s += kPeriodS) {
      Situation s;
      s.now = HostTime(from_seconds(t_s));
      if (server_up(t_s)) last_heartbeat = s.now;
      s.last_heartbeat = last_heartbeat;
      s.render_p95_ms = render_p95_ms(t_s);
      s.memory_peak_bytes = memory_bytes(t_s);
      s.bandwidth_bytes_per_s = bandwidth_bytes_per_s(t_s);
      s.round_trip_ms = round_trip_ms(t_s);
      steps.push_back({t_s, policy.evaluate(s)});
    }
    return steps;
  }
};

double noise(double t_s) {  // +-20 %, deterministic
  const double x = std::sin(t_s * 12.9898) * 43758.5453;
  return 0.8 + 0.4 * (x - std::floor(x));
}

TEST(OffloadPolicy, StaysLocalWhileTheRobotHasHeadroom) {
  Trace trace;
  trace.render_p95_ms = [](double) { return 20.0; };
  for (const auto& step : trace.run(60)) EXPECT_EQ(step.decision.mode, Mode::kLocal) << step.t_s;
}

TEST(OffloadPolicy, LatencyAloneOffloadsWithinThreeSeconds) {
  Trace trace;
  trace.render_p95_ms = [](double t_s) { return t_s < 20 ? 20.0 : 50.0; };
  for (const auto& step : trace.run(30)) {
    if (step.t_s < 20) {
      EXPECT_EQ(step.decision.mode, Mode::kLocal) << step.t_s;
    }
    if (step.t_s >= 23) {
      EXPECT_EQ(step.decision.mode, Mode::kFull) << step.t_s;
    }
    if (step.decision.changed) {
      EXPECT_EQ(step.decision.reason, Reason::kLatency);
    }
  }
}

TEST(OffloadPolicy, MemoryAloneOffloadsToo) {
  Trace trace;
  trace.render_p95_ms = [](double) { return 5.0; };
  trace.memory_bytes = [](double t_s) { return t_s < 5 ? 1e9 : 2e9; };
  const auto steps = trace.run(20);
  EXPECT_EQ(steps.back().decision.mode, Mode::kFull);
  EXPECT_EQ(steps.back().decision.reason, Reason::kMemory);
}

TEST(OffloadPolicy, LoadWithoutBandwidthPrunesAndStays) {
  Trace trace;
  trace.bandwidth_bytes_per_s = [](double) { return 20e3; };
  const auto steps = trace.run(20);
  EXPECT_EQ(steps.back().decision.mode, Mode::kLocal);
  EXPECT_TRUE(steps.back().decision.prune_and_compress);
}

TEST(OffloadPolicy, WithoutLoadNothingIsPrunedWhateverTheSetting) {
  for (const auto setting : {OffloadSetting::kAuto, OffloadSetting::kAlways, OffloadSetting::kNever}) {
    Trace trace;
    trace.config.setting = setting;
    trace.render_p95_ms = [](double t_s) { return t_s < 10 ? 20.0 : 50.0; };
    trace.bandwidth_bytes_per_s = [](double) { return 20e3; };
    for (const auto& step : trace.run(20))
      EXPECT_EQ(step.decision.prune_and_compress, step.t_s >= 10) << step.t_s;
  }
}

TEST(OffloadPolicy, NarrowLinkMeansLean) {
  Trace trace;
  trace.bandwidth_bytes_per_s = [](double) { return 150e3; };
  EXPECT_EQ(trace.run(20).back().decision.mode, Mode::kLean);
}

TEST(OffloadPolicy, ServerLossIsLocalWithinTwoAndAHalfSeconds) {
  Trace trace;
  trace.server_up = [](double t_s) { return t_s < 30; };
  for (const auto& step : trace.run(40)) {
    if (step.t_s >= 5 && step.t_s < 30) {
      EXPECT_EQ(step.decision.mode, Mode::kFull) << step.t_s;
    }
    if (step.t_s >= 32.5) {
      EXPECT_EQ(step.decision.mode, Mode::kLocal) << step.t_s;
    }
  }
}

TEST(OffloadPolicy, SettingsNeverAndAlways) {
  Trace trace;
  trace.config.setting = OffloadSetting::kNever;
  EXPECT_EQ(trace.run(60).back().decision.mode, Mode::kLocal);
  trace.config.setting = OffloadSetting::kAlways;
  trace.render_p95_ms = [](double) { return 1.0; };
  EXPECT_EQ(trace.run(60).back().decision.mode, Mode::kFull);
}

TEST(OffloadPolicy, UnknownBandwidthNeverOffloads) {
  OffloadPolicy policy{OffloadConfig{}};
  Situation s;
  s.render_p95_ms = 100.0;
  for (int i = 0; i < 50; ++i) {
    s.now = HostTime(from_seconds(kPeriodS * i));
    s.last_heartbeat = s.now;
    EXPECT_EQ(policy.evaluate(s).mode, Mode::kLocal);
  }
}

TEST(OffloadPolicy, FailedOffloadBacksOffLongerEachTime) {
  OffloadPolicy policy{OffloadConfig{}};
  Situation s;
  s.render_p95_ms = 100.0;
  s.bandwidth_bytes_per_s = 1e6;
  std::vector<double> entered_s;
  for (int i = 0; i < 600; ++i) {
    s.now = HostTime(from_seconds(kPeriodS * i));
    s.last_heartbeat = s.now;
    const Decision decision = policy.evaluate(s);
    if (decision.changed && decision.mode == Mode::kFull) entered_s.push_back(kPeriodS * i);
    s.offload_failed = decision.mode == Mode::kFull;  // every offload fails
  }
  ASSERT_GE(entered_s.size(), 4U);
  const auto gap = [&](std::size_t i) { return entered_s[i + 1] - entered_s[i]; };
  EXPECT_GE(gap(2), gap(0));
  EXPECT_GE(entered_s.back() - entered_s[entered_s.size() - 2], 40.0);
}

/// The promises of link-and-offload.md section 3 over traces of steps, ramps, noise and square waves.
class OffloadPromises : public testing::TestWithParam<double> {};

TEST_P(OffloadPromises, FewSwitchesAndNeverLongOnANarrowLink) {
  const double frequency_hz = GetParam();
  for (const double low_bytes_per_s : {5e3, 100e3, 250e3}) {
    Trace trace;
    trace.bandwidth_bytes_per_s = [=](double t_s) {
      const bool high = std::fmod(t_s * frequency_hz, 1.0) < 0.5;
      return (high ? 800e3 : low_bytes_per_s) * noise(t_s);
    };
    const double seconds = 400;
    int switches = 0;
    double narrow_s = 0.0;
    Mode before = Mode::kLocal;
    for (const auto& step : trace.run(seconds)) {
      switches += step.decision.changed ? 1 : 0;
      const double threshold = before == Mode::kFull ? trace.config.full_bandwidth_bytes_per_s
                                                     : trace.config.lean_bandwidth_bytes_per_s;
      const bool narrow = trace.bandwidth_bytes_per_s(step.t_s) < trace.config.leave_factor * threshold;
      narrow_s = before != Mode::kLocal && narrow && !step.decision.changed ? narrow_s + kPeriodS : 0.0;
      EXPECT_LE(narrow_s, 2.0) << "at " << step.t_s << " s, low " << low_bytes_per_s;
      before = step.decision.mode;
    }
    EXPECT_LE(switches, static_cast<int>(seconds / 10.0) + 1) << "low " << low_bytes_per_s;
  }
}
INSTANTIATE_TEST_SUITE_P(SquareWaves, OffloadPromises, testing::Values(0.05, 0.1, 0.25, 0.5, 1.0, 2.0));

TEST(OffloadPolicy, NoiseAroundAThresholdDoesNotFlap) {
  Trace trace;
  trace.bandwidth_bytes_per_s = [](double t_s) { return 300e3 * noise(t_s); };
  int switches = 0;
  for (const auto& step : trace.run(300)) switches += step.decision.changed ? 1 : 0;
  EXPECT_LE(switches, 2);
}

TEST(OffloadPolicy, RampPassesThroughLeanOnTheWayDown) {
  Trace trace;
  trace.bandwidth_bytes_per_s = [](double t_s) { return std::max(1e3, 800e3 - 10e3 * t_s); };
  bool lean_seen = false;
  Mode before = Mode::kFull;
  for (const auto& step : trace.run(90)) {
    if (step.t_s < 5) continue;
    EXPECT_LE(step.decision.mode, before) << "never back up";
    lean_seen |= step.decision.mode == Mode::kLean;
    before = step.decision.mode;
  }
  EXPECT_TRUE(lean_seen);
  EXPECT_EQ(before, Mode::kLocal);
}

}  // namespace
}  // namespace edgesplat::policy
