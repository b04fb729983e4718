// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Both ends of a link in virtual time, made worse on purpose.
#include "test/common/link/simulated_link.hpp"
#include "test/support/message_bytes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace edgesplat::link {
namespace {

using test::message_bytes;

constexpr map::RobotId kRobot = SimulatedLink::kRobot;

LinkEndOptions impaired(const ImpairmentConfig& impair) {
  LinkEndOptions options;
  options.impair = impair;
  return options;
}
ImpairmentConfig shaped(std::vector<double> at_s, std::vector<double> bytes_per_s) {
  ImpairmentConfig config;
  config.shape_at_s = std::move(at_s);
  config.shape_bytes_per_s = std::move(bytes_per_s);
  config.delay_ms = 10;
  return config;
}

TEST(LinkEnd, EverythingArrivesOnceAndWholeOverABadLink) {
  ImpairmentConfig bad;
  bad.loss = 0.05;
  bad.duplicate = 0.05;
  bad.reorder = 0.1;
  bad.flip_bits = 0.02;
  bad.delay_ms = 5;
  ImpairmentConfig back = bad;
  back.seed = 2;
  SimulatedLink link(impaired(bad), impaired(back));
  std::vector<std::vector<std::byte>> messages;
  for (std::uint32_t i = 0; i < 60; ++i) messages.push_back(message_bytes(1000 + 14001 * (i % 9), i));
  for (const auto& message : messages) ASSERT_TRUE(link.robot().send(Lane::kKeyframe, kRobot, message));
  std::vector<int> times(messages.size(), 0);
  link.run(20, [&](double) {
    while (const auto message = link.server().receive(nanoseconds(0))) {
      const auto found = std::find(messages.begin(), messages.end(), message->bytes);
      ASSERT_NE(found, messages.end());
      ++times[static_cast<std::size_t>(found - messages.begin())];
    }
  });
  EXPECT_EQ(std::count(times.begin(), times.end(), 1), 60);
  const LaneCounters sent = link.robot().counters()[index_of(Lane::kKeyframe)];
  const LaneCounters received = link.server().counters()[index_of(Lane::kKeyframe)];
  EXPECT_EQ(sent.messages_acked, 60U);
  EXPECT_EQ(sent.messages_given_up, 0U);
  EXPECT_EQ(sent.flying_messages, 0U);
  EXPECT_GT(sent.chunks_resent, 0U);
  EXPECT_GT(received.chunks_corrupt, 0U);
  EXPECT_EQ(received.messages_corrupt, 0U);
  EXPECT_LT(sent.chunks_resent, sent.chunks_sent / 5);
}

TEST(LinkEnd, DeltasAreRepairedToo) {
  ImpairmentConfig bad;
  bad.loss = 0.2;
  SimulatedLink link({}, impaired(bad));
  for (std::uint32_t i = 0; i < 40; ++i) {
    ASSERT_TRUE(link.server().send(Lane::kDelta, kRobot, message_bytes(20000, i)));
  }
  std::size_t came = 0;
  link.run(20, [&](double) {
    while (link.robot().receive(nanoseconds(0))) ++came;
  });
  EXPECT_EQ(came, 40U);
}

TEST(LinkEnd, AStuckReceiverBoundsEveryQueue) {
  LinkEndOptions robot;
  robot.send.messages = 8;
  LinkEndOptions server;
  server.inbox_messages = 4;
  SimulatedLink link(robot, server);
  std::uint32_t i = 0;
  link.run(5, [&](double) { (void)link.robot().send(Lane::kKeyframe, kRobot, message_bytes(40000, ++i)); });
  const LaneCounters keyframes = link.robot().counters()[index_of(Lane::kKeyframe)];
  EXPECT_LE(keyframes.queued_messages, 8U);
  EXPECT_LE(keyframes.flying_messages, 32U);
  EXPECT_GT(keyframes.messages_dropped, 4000U);
  // Heartbeats still come through to the link, and the inbox stays at its bound.
  std::size_t taken = 0;
  while (link.server().receive(nanoseconds(0))) ++taken;
  EXPECT_LE(taken, 4U);
}

TEST(LinkEnd, EstimatesAShapedLinkFromAcknowledgements) {
  for (const double rate : {25e3, 125e3, 1.25e6}) {
    SimulatedLink link(impaired(shaped({0.0}, {rate})));
    std::uint32_t i = 0;
    link.run(4, [&](double) {
      if (link.robot().counters()[index_of(Lane::kKeyframe)].queued_messages < 2) {
        (void)link.robot().send(Lane::kKeyframe, kRobot, message_bytes(60000, ++i));
      }
      while (link.server().receive(nanoseconds(0))) {
      }
    });
    const LinkQuality quality = link.robot().quality(kRobot);
    ASSERT_TRUE(quality.bandwidth_bytes_per_s.has_value()) << rate;
    EXPECT_NEAR(*quality.bandwidth_bytes_per_s, rate, 0.25 * rate);
    EXPECT_EQ(*quality.shaped_bytes_per_s, rate);
  }
}

TEST(LinkEnd, FollowsStepsOfTheShaperWithinTwoSeconds) {
  const std::vector<double> at_s = {0, 4, 10, 20};
  const std::vector<double> rates = {1e6, 125e3, 25e3, 1e6};
  SimulatedLink link(impaired(shaped(at_s, rates)));
  std::uint32_t i = 0;
  double worst = 0.0;
  double worst_at = 0.0;
  link.run(25, [&](double t_s) {
    if (link.robot().counters()[index_of(Lane::kKeyframe)].queued_messages < 2) {
      (void)link.robot().send(Lane::kKeyframe, kRobot, message_bytes(60000, ++i));
    }
    while (link.server().receive(nanoseconds(0))) {
    }
    double since = 0.0;
    for (const double at : at_s) since = t_s >= at ? t_s - at : since;
    if (since < 2.0) return;
    const LinkQuality quality = link.robot().quality(kRobot);
    const double error = std::abs(*quality.bandwidth_bytes_per_s / *quality.shaped_bytes_per_s - 1.0);
    if (error > worst) {
      worst = error;
      worst_at = t_s;
    }
  });
  EXPECT_LT(worst, 0.25) << "at " << worst_at << " s";
}

TEST(LinkEnd, ProbesAnIdleLinkOnlyWhereADecisionDependsOnIt) {
  SimulatedLink link(impaired(shaped({0.0}, {200e3})));
  link.run(10);
  EXPECT_EQ(link.robot().counters()[index_of(Lane::kProbe)].messages_sent, 0U);
  EXPECT_FALSE(link.robot().quality(kRobot).bandwidth_bytes_per_s.has_value());
  link.robot().allow_probing(true);
  link.run(1);
  ASSERT_TRUE(link.robot().quality(kRobot).bandwidth_bytes_per_s.has_value());
  EXPECT_NEAR(*link.robot().quality(kRobot).bandwidth_bytes_per_s, 200e3, 60e3);
  link.run(60);
  const auto probes = link.robot().counters()[index_of(Lane::kProbe)];
  EXPECT_LT(static_cast<double>(probes.bytes_sent) / 61.0, 0.03 * 200e3);
  EXPECT_FALSE(link.server().receive(nanoseconds(0)).has_value());  // nobody else sees them
}

TEST(LinkEnd, AProbeIsNotFooledByTheBurstThatTheNetworkLetsThrough) {
  ImpairmentConfig config = shaped({0.0}, {120e3});
  config.delay_ms = 0;  // each packet of the burst is acknowledged before the next leaves
  SimulatedLink link(impaired(config));
  link.robot().allow_probing(true);
  link.run(1);
  ASSERT_TRUE(link.robot().quality(kRobot).bandwidth_bytes_per_s.has_value());
  EXPECT_LT(*link.robot().quality(kRobot).bandwidth_bytes_per_s, 1.5 * 120e3);
}

// A lost probe is not sent again: that nothing more comes says nothing of the link.
TEST(LinkEnd, LostProbesAreNoSilence) {
  ImpairmentConfig config = shaped({0.0}, {200e3});
  config.loss = 0.2;
  SimulatedLink link(impaired(config));
  link.robot().allow_probing(true);
  link.run(1);
  double least = 1e9;
  link.run(60, [&](double) {
    while (link.server().receive(nanoseconds(0))) {
    }
    least = std::min(least, link.robot().quality(kRobot).bandwidth_bytes_per_s.value_or(1e9));
  });
  EXPECT_GT(least, 50e3);
}

TEST(LinkEnd, AProbeOfAWideLinkFindsAsMuchAsItWasPacedAt) {
  SimulatedLink link;
  link.robot().allow_probing(true);
  link.run(1);
  ASSERT_TRUE(link.robot().quality(kRobot).bandwidth_bytes_per_s.has_value());
  EXPECT_GT(*link.robot().quality(kRobot).bandwidth_bytes_per_s, 1.25 * 300e3);
}

TEST(LinkEnd, HeartbeatsMeasureTheRoundTripAndOvertakeBulk) {
  SimulatedLink link(impaired(shaped({0.0}, {25e3})));
  for (std::uint32_t i = 0; i < 20; ++i) {
    (void)link.robot().send(Lane::kKeyframe, kRobot, message_bytes(60000, i));
  }
  int heartbeats = 0;
  int ms = 0;
  link.run(4, [&](double) {
    if (ms++ % 200 == 0) (void)link.robot().send(Lane::kHeartbeat, kRobot, message_bytes(60));
    while (const auto message = link.server().receive(nanoseconds(0))) {
      heartbeats += message->lane == Lane::kHeartbeat ? 1 : 0;
    }
  });
  EXPECT_GE(heartbeats, 19);
  ASSERT_TRUE(link.robot().quality(kRobot).round_trip_ms.has_value());
  EXPECT_NEAR(*link.robot().quality(kRobot).round_trip_ms, 10.0, 3.0);
}

TEST(LinkEnd, TheSpoolWaitsForEverythingElse) {
  SimulatedLink link(impaired(shaped({0.0}, {50e3})));
  for (std::uint32_t i = 0; i < 5; ++i) {
    (void)link.robot().send(Lane::kSpool, kRobot, message_bytes(20000, i));
    (void)link.robot().send(Lane::kKeyframe, kRobot, message_bytes(20000, 100 + i));
  }
  std::vector<Lane> order;
  link.run(8, [&](double) {
    while (const auto message = link.server().receive(nanoseconds(0))) order.push_back(message->lane);
  });
  ASSERT_EQ(order.size(), 10U);
  EXPECT_EQ(std::count(order.begin(), order.begin() + 5, Lane::kKeyframe), 5);
}

}  // namespace
}  // namespace edgesplat::link
