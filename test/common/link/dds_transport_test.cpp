// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/dds_transport.hpp"

#include "test/support/message_bytes.hpp"
#include "test/support/test_domain.hpp"

#include <gtest/gtest.h>

namespace edgesplat::link {
namespace {

using test::message_bytes;

constexpr nanoseconds kPatience = std::chrono::seconds(20);
constexpr map::RobotId kRobot{4};

class DdsTransportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    LinkConfig config;
    config.domain = test::test_domain();
    config.inbox_messages = 4;
    auto domain = DdsDomain::open(config);
    ASSERT_TRUE(domain.has_value()) << domain.error().context;
    domain_ = *domain;
  }
  std::unique_ptr<Transport> open(Role role, map::RobotId robot = kRobot) {
    auto transport = open_dds_transport(domain_, {role, robot, 0}, clock_);
    EXPECT_TRUE(transport.has_value());
    return std::move(*transport);
  }
  SteadyClock clock_;
  std::shared_ptr<DdsDomain> domain_;
};

TEST_F(DdsTransportTest, KeyframesGoUpAndDeltasDownWhole) {
  const auto robot = open(Role::kRobot);
  const auto server = open(Role::kServer);
  // Far more than the inbox and DDS hold: the sender is held back, nothing is lost.
  constexpr std::uint32_t kMessages = 40;
  for (std::uint32_t i = 0; i < kMessages; ++i) {
    ASSERT_TRUE(robot->send(Lane::kKeyframe, kRobot, message_bytes(300000 + i, i)));
  }
  for (std::uint32_t i = 0; i < kMessages; ++i) {
    const auto message = server->receive(kPatience);
    ASSERT_TRUE(message.has_value()) << "message " << i;
    EXPECT_EQ(message->lane, Lane::kKeyframe);
    EXPECT_EQ(message->robot, kRobot);
    EXPECT_EQ(message->bytes, message_bytes(300000 + i, i));
  }
  EXPECT_TRUE(robot->drain(Lane::kKeyframe, kPatience));
  EXPECT_EQ(robot->counters()[static_cast<std::size_t>(Lane::kKeyframe)].messages_acked, kMessages);
  ASSERT_TRUE(server->send(Lane::kDelta, kRobot, message_bytes(1000)));
  const auto delta = robot->receive(kPatience);
  ASSERT_TRUE(delta.has_value());
  EXPECT_EQ(delta->bytes, message_bytes(1000));
  EXPECT_TRUE(robot->connected());
}

TEST_F(DdsTransportTest, ARobotDoesNotSeeAnotherRobotsDeltas) {
  const auto robot = open(Role::kRobot, map::RobotId{1});
  const auto other = open(Role::kRobot, map::RobotId{2});
  const auto server = open(Role::kServer);
  ASSERT_TRUE(robot->send(Lane::kKeyframe, map::RobotId{1}, message_bytes(10)));
  ASSERT_TRUE(other->send(Lane::kKeyframe, map::RobotId{2}, message_bytes(10)));
  ASSERT_TRUE(server->receive(kPatience) && server->receive(kPatience));
  // Both robots are heard; each gets only its own.
  ASSERT_TRUE(server->send(Lane::kDelta, map::RobotId{2}, message_bytes(22)));
  ASSERT_TRUE(server->send(Lane::kDelta, map::RobotId{1}, message_bytes(11)));
  EXPECT_EQ(robot->receive(kPatience)->bytes, message_bytes(11));
  EXPECT_FALSE(robot->receive(std::chrono::milliseconds(50)).has_value());
}

TEST_F(DdsTransportTest, WhatIsSentBeforeThePeerComesWaitsForIt) {
  const auto robot = open(Role::kRobot);
  ASSERT_TRUE(robot->send(Lane::kKeyframe, kRobot, message_bytes(100)));
  EXPECT_FALSE(robot->connected());
  EXPECT_FALSE(robot->drain(Lane::kKeyframe, std::chrono::milliseconds(50)));
  const auto server = open(Role::kServer);
  ASSERT_TRUE(server->receive(kPatience).has_value());
  EXPECT_TRUE(robot->drain(Lane::kKeyframe, kPatience));
}

TEST_F(DdsTransportTest, CloseWakesTheReader) {
  const auto robot = open(Role::kRobot);
  robot->close();
  EXPECT_FALSE(robot->receive(kPatience).has_value());
}

TEST(DdsDomain, NamesAMissingInterface) {
  LinkConfig config;
  config.interface = "nosuch0";
  const auto domain = DdsDomain::open(config);
  ASSERT_FALSE(domain.has_value());
  EXPECT_EQ(domain.error().code, Errc::kInvalidConfig);
  EXPECT_NE(domain.error().context.find("nosuch0"), std::string::npos);
}

}  // namespace
}  // namespace edgesplat::link
