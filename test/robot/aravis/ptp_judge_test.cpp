// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/ptp_judge.hpp"

#include <gtest/gtest.h>

namespace edgesplat::aravis {
namespace {

HostTime at(double seconds) {
  return host_time_from_ns(0) + from_seconds(seconds);
}

TEST(PtpJudge, ASlaveIsBelievedAfterTheSettleTime) {
  PtpJudge judge(10.0, 5.0);
  for (double t = 0; t < 4.9; t += 0.25) {
    judge.observe({"Slave", 3'000}, at(t));
    EXPECT_FALSE(judge.disciplined()) << t;
  }
  judge.observe({"Slave", 3'000}, at(5.0));
  EXPECT_TRUE(judge.disciplined());
}

TEST(PtpJudge, OneOffsetOverTheLimitBeginsTheWaitAnew) {
  PtpJudge judge(10.0, 1.0);
  judge.observe({"Slave", 0}, at(0.0));
  judge.observe({"Slave", -11'000}, at(0.9));
  judge.observe({"Slave", 0}, at(1.2));
  EXPECT_FALSE(judge.disciplined());
  judge.observe({"Slave", 0}, at(2.2));
  EXPECT_TRUE(judge.disciplined());
}

TEST(PtpJudge, NoSlaveIsNeverBelievedAndASlaveNoMoreIsDropped) {
  PtpJudge judge(10.0, 0.0);
  for (const char* status : {"Listening", "Uncalibrated", "Master", "Disabled", ""}) {
    judge.observe({status, 0}, at(100.0));
    EXPECT_FALSE(judge.disciplined()) << status;
  }
  judge.observe({"Slave", std::nullopt}, at(101.0));  // a camera that does not tell its offset
  EXPECT_TRUE(judge.disciplined());
  judge.observe({"Listening", 0}, at(102.0));
  EXPECT_FALSE(judge.disciplined());
}

TEST(PtpJudge, ASwingOfTheServoIsBorneButNotAStep) {
  PtpJudge judge(10.0, 0.0);
  judge.observe({"Slave", 0}, at(0.0));
  judge.observe({"Slave", 60'000}, at(1.0));
  EXPECT_TRUE(judge.disciplined());
  judge.observe({"Slave", -150'000}, at(2.0));
  EXPECT_FALSE(judge.disciplined());
}

}  // namespace
}  // namespace edgesplat::aravis
