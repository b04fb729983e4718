// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/config/robot_config.hpp"

#include "common/config/config_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace edgesplat::robot_config {
namespace {

using testing::HasSubstr;

Result<RobotConfig> read(const std::string& text, const std::string& override_text = "") {
  EDGESPLAT_TRY(config::ConfigFile file, config::ConfigFile::parse(text, "robot.toml"));
  if (!override_text.empty()) {
    EDGESPLAT_TRY_STATUS(file.apply_override(override_text));
  }
  RobotConfig config;
  EDGESPLAT_TRY_STATUS(file.read_into(config));
  return config;
}

std::string error_of(const std::string& text) {
  const auto config = read(text);
  return config ? "" : config.error().context;
}

TEST(RobotConfig, OneLidarIsATableAsBefore) {
  const auto plain = read("");
  ASSERT_TRUE(plain.has_value()) << plain.error().context;
  ASSERT_EQ(plain->livox.size(), 1U);
  EXPECT_EQ(plain->livox[0].points_port, 56301);
  const auto one = read("[livox]\nmodel = \"mid360\"\nimu_port = 7000", "livox.serial=47MDTEST000001");
  ASSERT_TRUE(one.has_value()) << one.error().context;
  EXPECT_EQ(one->livox[0].model, livox::LidarChoice::kMid360);
  EXPECT_EQ(one->livox[0].imu_port, 7000);
  EXPECT_EQ(one->livox[0].serial, "47MDTEST000001");
  EXPECT_THAT(config::to_toml(*one), HasSubstr("\n[livox]\n"));
}

TEST(RobotConfig, SeveralLidarsHavePortsOfTheirOwnWithoutBeingTold) {
  const auto config = read(
      "[[livox]]\nmodel = \"mid360\"\nserial = \"A\"\n[[livox]]\nmodel = \"avia\"\naddress = "
      "\"192.168.1.120\"\npoints_port = 60000\n[[livox]]\n",
      "livox.2.imu_port=61000");
  ASSERT_TRUE(config.has_value()) << config.error().context;
  ASSERT_EQ(config->livox.size(), 3U);
  EXPECT_EQ(config->livox[0].imu_port, 56401);
  EXPECT_EQ(config->livox[1].imu_port, 56402);
  EXPECT_EQ(config->livox[1].points_port, 60000);
  EXPECT_EQ(config->livox[1].control_port, 56102);
  EXPECT_EQ(config->livox[2].push_port, 56203);
  EXPECT_EQ(config->livox[2].imu_port, 61000);
  const auto again = read(config::to_toml(*config));
  ASSERT_TRUE(again.has_value()) << again.error().context;
  EXPECT_EQ(again->livox[1].address, "192.168.1.120");
  EXPECT_EQ(again->livox[1].points_port, 60000);
}

TEST(RobotConfig, RefusesLidarsThatGetInEachOthersWay) {
  EXPECT_THAT(error_of("[[livox]]\nmodel = \"mid360\"\nserial = \"A\"\n[[livox]]\nmodel = \"mid360\""),
              HasSubstr("[[livox]] 1 needs a serial number or an address"));
  EXPECT_THAT(error_of("[[livox]]\nserial = \"A\"\n[[livox]]\nserial = \"A\""),
              HasSubstr("[[livox]] 0 and 1 have the same serial"));
  EXPECT_THAT(error_of("[[livox]]\naddress = \"10.0.0.1\"\n[[livox]]\naddress = \"10.0.0.1\""),
              HasSubstr("[[livox]] 0 and 1 have the same address"));
  EXPECT_THAT(error_of("[[livox]]\n[[livox]]\nimu_port = 56301"),
              HasSubstr("[[livox]] 0 and 1 both use UDP port 56301"));
  // 0 is any free port; other cards' ports are others.
  EXPECT_EQ(error_of("[[livox]]\ncontrol_port = 0\n[[livox]]\ncontrol_port = 0"), "");
  EXPECT_EQ(error_of("[[livox]]\nbind_address = \"10.0.0.1\"\n[[livox]]\nbind_address = \"10.0.1.1\"\n"
                     "points_port = 56301"),
            "");
}

}  // namespace
}  // namespace edgesplat::robot_config
