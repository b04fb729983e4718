// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/silence_watch.hpp"

#include <gtest/gtest.h>

namespace edgesplat::aravis {
namespace {

using namespace std::chrono_literals;

HostTime at(nanoseconds t) {
  return HostTime{} + 5s + t;
}

TEST(SilenceWatch, GrowsWhileNothingComesAndBeginsAnewWhenSomethingDoes) {
  SilenceWatch watch;
  watch.heard(at(0ms));
  watch.listened(at(1ms), at(502ms), 500ms);
  watch.listened(at(503ms), at(603ms), 100ms);
  EXPECT_EQ(watch.silence(at(603ms)), 603ms);
  watch.heard(at(700ms));
  EXPECT_EQ(watch.silence(at(710ms)), 10ms);
  EXPECT_EQ(watch.last_heard(), at(700ms));
}

TEST(SilenceWatch, TimeInWhichTheRobotWasHeldUpIsNotTheDevices) {
  SilenceWatch watch;
  watch.heard(at(0ms));
  watch.listened(at(2000ms), at(2100ms), 100ms);  // nobody listened for 2 s
  EXPECT_EQ(watch.silence(at(2100ms)), 100ms);
  watch.listened(at(2100ms), at(5200ms), 100ms);  // a wait of 0.1 s that took 3.1
  EXPECT_EQ(watch.silence(at(5200ms)), 200ms);
  watch.listened(at(5200ms), at(5700ms), 500ms);
  EXPECT_EQ(watch.silence(at(5700ms)), 700ms);
}

}  // namespace
}  // namespace edgesplat::aravis
