// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/in_process_transport.hpp"

#include "test/support/message_bytes.hpp"

#include <gtest/gtest.h>

namespace edgesplat::link {
namespace {

using test::message_bytes;

TEST(InProcessLink, CarriesMessagesBothWays) {
  const auto link = make_in_process_link(map::RobotId{5});
  EXPECT_TRUE(link.robot->connected());
  EXPECT_TRUE(link.robot->send(Lane::kKeyframe, map::RobotId{5}, message_bytes(100)));
  EXPECT_TRUE(link.server->send(Lane::kDelta, map::RobotId{5}, message_bytes(50)));
  EXPECT_EQ(link.server->receive(nanoseconds(0))->bytes, message_bytes(100));
  EXPECT_EQ(link.robot->receive(nanoseconds(0))->bytes, message_bytes(50));
  EXPECT_FALSE(link.robot->receive(nanoseconds(0)).has_value());
}

TEST(InProcessLink, RefusesLanesThatRunTheOtherWay) {
  const auto link = make_in_process_link(map::RobotId{5});
  EXPECT_FALSE(link.robot->send(Lane::kDelta, map::RobotId{5}, message_bytes(1)));
  EXPECT_FALSE(link.server->send(Lane::kKeyframe, map::RobotId{5}, message_bytes(1)));
}

TEST(InProcessLink, AFullInboxIsCounted) {
  const auto link = make_in_process_link(map::RobotId{5}, 2);
  for (int i = 0; i < 5; ++i) (void)link.robot->send(Lane::kKeyframe, map::RobotId{5}, message_bytes(10));
  const auto counters = link.robot->counters()[static_cast<std::size_t>(Lane::kKeyframe)];
  EXPECT_EQ(counters.messages_sent, 2U);
  EXPECT_EQ(counters.inbox_drops, 3U);
}

TEST(InProcessLink, AClosedEndIsGone) {
  auto link = make_in_process_link(map::RobotId{5});
  link.server.reset();
  EXPECT_FALSE(link.robot->connected());
  EXPECT_FALSE(link.robot->send(Lane::kKeyframe, map::RobotId{5}, message_bytes(10)));
}

}  // namespace
}  // namespace edgesplat::link
