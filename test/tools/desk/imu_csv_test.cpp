// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/imu_csv.hpp"

#include <gtest/gtest.h>

#include <string>

namespace edgesplat::desk {
namespace {

TEST(ImuCsv, ReadsEurocRows) {
  const auto samples = parse_imu_csv(
      "#timestamp "
      "[ns],w_x\n1403636579758555392,-0.1,0.2,3e-2,8.1,-0.37,-2.4\r\n1.403636579763555584E+018,0,0,0,0,0,9."
      "81\n\n,,,,,,\n1403636763.853,,,,,,\n",
      "imu.csv");
  ASSERT_TRUE(samples.has_value()) << samples.error().context;
  ASSERT_EQ(samples->size(), 2U);
  EXPECT_EQ(to_ns((*samples)[0].stamp), 1403636579758555392);
  EXPECT_EQ(to_ns((*samples)[1].arrival), 1403636579763555584);
  EXPECT_DOUBLE_EQ((*samples)[0].gyro_radps.z(), 0.03);
  EXPECT_DOUBLE_EQ((*samples)[0].accel_mps2.x(), 8.1);
}

TEST(ImuCsv, NamesTheLineOfARowItCannotRead) {
  const std::string good = "1,0,0,0,0,0,9.81\n";
  for (const char* bad :
       {"2,0,0,0,0,0", "2,0,0,0,0,0,9.81,1", "2,0,0,x,0,0,9.81", "2,0,0,nan,0,0,9.81", "2,0,0,inf,0,0,1",
        "1e300,0,0,0,0,0,9.81", "nan,0,0,0,0,0,9.81", "1,0,0,0,0,0,9.81", "0,0,0,0,0,0,9.81", "2;0;0"}) {
    const auto samples = parse_imu_csv(good + bad, "imu.csv");
    ASSERT_FALSE(samples.has_value()) << bad;
    EXPECT_EQ(samples.error().code, Errc::kCorrupt);
    EXPECT_NE(samples.error().context.find("imu.csv:2"), std::string::npos) << samples.error().context;
  }
}

TEST(ImuCsv, EveryTruncationIsEitherReadOrRefused) {
  const std::string text = "#t\n100,0.1,0.2,0.3,1,2,9.81\n200,0.1,0.2,0.3,1,2,9.81\n";
  for (std::size_t length = 0; length <= text.size(); ++length) {
    const auto samples = parse_imu_csv(std::string_view(text).substr(0, length), "imu.csv");
    EXPECT_TRUE(samples.has_value() ? samples->size() <= 2 : samples.error().code == Errc::kCorrupt);
  }
}

TEST(ImuCsv, AMissingFileIsNotFound) {
  const auto samples = read_imu_csv("/nonexistent/imu.csv");
  ASSERT_FALSE(samples.has_value());
  EXPECT_EQ(samples.error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace edgesplat::desk
