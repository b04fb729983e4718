// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/keyframe_router.hpp"

#include <gtest/gtest.h>

#include <string>

namespace edgesplat::uplink {
namespace {

using Way = KeyframeRouter::Way;
using link::OffloadMode;

HostTime at(double seconds) {
  return HostTime(from_seconds(seconds));
}

TEST(KeyframeRouter, FullSendsAllLeanEveryThirdLocalNone) {
  KeyframeRouter router({}, at(0));
  const auto sent_of_nine = [&] {
    std::string sent;
    for (int i = 0; i < 9; ++i)
      sent += router.route(router.mode_sends_next(), 1000, {}, at(1)) == Way::kSend ? 'x' : '.';
    return sent;
  };
  EXPECT_EQ(sent_of_nine(), "xxxxxxxxx");
  router.set_mode(OffloadMode::kLean, {}, at(1));
  EXPECT_EQ(sent_of_nine(), "x..x..x..");
  router.set_mode(OffloadMode::kLocal, {}, at(1));
  EXPECT_EQ(sent_of_nine(), ".........");
  EXPECT_FALSE(router.may_send_kept(1, {}, at(100)));
}

/// Bytes a second sent in a minute when a keyframe of `bytes` comes `per_s` times a second and what is kept
/// is sent when it may be.
double mean_sent(OffloadMode mode, std::size_t bytes, double per_s) {
  RouterConfig config;
  config.full_bytes_per_s = 280e3;
  config.lean_bytes_per_s = 54e3;
  KeyframeRouter router(config, at(0));
  router.set_mode(mode, {}, at(0));
  LinkLoad load;  // what is sent is gone at once
  int kept = 0;
  double next_keyframe_s = 0.0;
  for (double t = 0.0; t < 60.0; t += 0.05) {
    if (t >= next_keyframe_s) {
      next_keyframe_s += 1.0 / per_s;
      const bool now = router.route(router.mode_sends_next(), bytes, load, at(t)) == Way::kSend;
      load.sent_bytes += now ? bytes : 0;
      kept += now ? 0 : 1;
    } else if (kept > 0 && router.may_send_kept(bytes, load, at(t))) {
      load.sent_bytes += bytes;
      --kept;
    }
  }
  return static_cast<double>(load.sent_bytes) / 60.0;
}

TEST(KeyframeRouter, KeepsTheBudgetOfTheModeWhateverComes) {
  for (const std::size_t bytes : {5'000U, 30'000U, 150'000U}) {
    for (const double per_s : {1.0, 5.0, 10.0}) {
      EXPECT_LE(mean_sent(OffloadMode::kFull, bytes, per_s), 300e3) << bytes << " x " << per_s;
      EXPECT_LE(mean_sent(OffloadMode::kLean, bytes, per_s), 60e3) << bytes << " x " << per_s;
      EXPECT_EQ(mean_sent(OffloadMode::kLocal, bytes, per_s), 0.0);
    }
  }
}

TEST(KeyframeRouter, InLeanWhatIsKeptLeavesRoomForTheNextThird) {
  RouterConfig config;
  config.lean_bytes_per_s = 57e3;
  config.keyframe_bytes = 130'000;
  config.lean_reserve_bytes = 40'000;
  KeyframeRouter router(config, at(0));
  router.set_mode(OffloadMode::kLean, {}, at(0));
  LinkLoad load;
  int kept_by_budget = 0;
  int late = 0;
  for (int i = 0; i < 600; ++i) {  // a keyframe every 0.45 s, nine times between them one that was kept
    const double t = 0.05 * i;
    if (i % 9 == 0) {
      const Way way = router.route(router.mode_sends_next(), 40'000, load, at(t));
      load.sent_bytes += way == Way::kSend ? 40'000 : 0;
      kept_by_budget += t > 2.0 && way == Way::kKeepBudget ? 1 : 0;
    } else if (router.may_send_kept(40'000, load, at(t))) {
      load.sent_bytes += 40'000;
      ++late;
    }
  }
  EXPECT_EQ(kept_by_budget, 0);
  EXPECT_GT(late, 10);
}

TEST(KeyframeRouter, OneThatTheBudgetKeepsIsMadeUpForByTheNext) {
  RouterConfig config;
  config.lean_bytes_per_s = 10e3;
  KeyframeRouter router(config, at(0));
  router.set_mode(OffloadMode::kLean, {}, at(0));
  EXPECT_EQ(router.route(router.mode_sends_next(), 8'000, {}, at(0.1)), Way::kKeepBudget);
  EXPECT_EQ(router.route(router.mode_sends_next(), 8'000, {}, at(0.9)), Way::kSend);
  EXPECT_EQ(router.route(router.mode_sends_next(), 8'000, {8'000, 0}, at(1.0)), Way::kKeepMode);
}

TEST(KeyframeRouter, UsesTheBudgetThatThereIs) {
  EXPECT_GE(mean_sent(OffloadMode::kFull, 30'000, 15.0), 250e3);
  EXPECT_GE(mean_sent(OffloadMode::kLean, 30'000, 15.0), 48e3);
}

}  // namespace
}  // namespace edgesplat::uplink
