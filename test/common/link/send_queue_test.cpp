// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/send_queue.hpp"

#include "test/support/message_bytes.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace edgesplat::link {
namespace {

using test::message_bytes;

constexpr LaneMask kAll = kAllLanes;
constexpr HostTime kNow{};
constexpr map::RobotId kRobot{1};

const LaneCounters& of(const LinkCounters& counters, Lane lane) {
  return counters[static_cast<std::size_t>(lane)];
}

TEST(SendQueue, UrgentLanesOvertakeATrainBetweenItsChunks) {
  SendQueue queue(7, {});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(3 * kChunk_bytes));
  ASSERT_EQ(queue.next(kAll, kNow)->lane, Lane::kKeyframe);
  queue.sent(kNow);
  queue.push(Lane::kHeartbeat, kRobot, message_bytes(10));
  ASSERT_EQ(queue.next(kAll, kNow)->lane, Lane::kHeartbeat);
  queue.sent(kNow);
  const auto part = queue.next(kAll, kNow);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->lane, Lane::kKeyframe);
  EXPECT_EQ(part->header.index, 1U);
  EXPECT_EQ(part->header.train, 1U);
}

TEST(SendQueue, UnreachableLanesWait) {
  SendQueue queue(7, {});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(10));
  EXPECT_FALSE(queue.next(LaneMask{}, kNow).has_value());
  EXPECT_TRUE(queue.next(kAll, kNow).has_value());
}

TEST(SendQueue, AFullLaneDropsItsOldestAndNeverWhatIsUnderWay) {
  SendQueue queue(7, {3, 1U << 20U, {}});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(2 * kChunk_bytes, 0));
  (void)queue.next(kAll, kNow);
  queue.sent(kNow);
  for (std::uint32_t i = 1; i <= 10; ++i)
    EXPECT_TRUE(queue.push(Lane::kKeyframe, kRobot, message_bytes(10, i)));
  const auto counters = queue.counters();
  EXPECT_EQ(of(counters, Lane::kKeyframe).queued_messages, 3U);
  EXPECT_EQ(of(counters, Lane::kKeyframe).flying_messages, 1U);
  EXPECT_EQ(of(counters, Lane::kKeyframe).messages_dropped, 7U);
  EXPECT_EQ(queue.next(kAll, kNow)->header.index, 1U);  // still the first train
  queue.sent(kNow);
  const auto part = queue.next(kAll, kNow);
  EXPECT_EQ(part->header.train, 2U);  // what was shed leaves no gap in the numbers
  const auto eighth = message_bytes(10, 8);
  EXPECT_TRUE(std::equal(part->payload.begin(), part->payload.end(), eighth.begin(), eighth.end()));
}

TEST(SendQueue, BytesAreBoundedToo) {
  SendQueue queue(7, {1000, 1000, {}});
  for (std::uint32_t i = 0; i < 50; ++i) queue.push(Lane::kKeyframe, kRobot, message_bytes(400));
  EXPECT_LE(of(queue.counters(), Lane::kKeyframe).queued_bytes, 1000U);
  EXPECT_FALSE(queue.push(Lane::kKeyframe, kRobot, message_bytes(1001)));
  EXPECT_FALSE(queue.push(Lane::kKeyframe, kRobot, {}));
  const LaneCounters counters = of(queue.counters(), Lane::kKeyframe);
  EXPECT_EQ(counters.messages_offered, counters.messages_dropped + counters.queued_messages);
}

TEST(SendQueue, OnlyTheNewestHeartbeatWaits) {
  SendQueue queue(7, {});
  for (std::uint32_t i = 0; i < 5; ++i) queue.push(Lane::kHeartbeat, kRobot, message_bytes(8, i));
  queue.push(Lane::kHeartbeat, map::RobotId{2}, message_bytes(8, 9));
  EXPECT_EQ(of(queue.counters(), Lane::kHeartbeat).queued_messages, 2U);
  EXPECT_EQ(of(queue.counters(), Lane::kHeartbeat).messages_replaced, 4U);
  EXPECT_EQ(of(queue.counters(), Lane::kHeartbeat).queued_bytes, 16U);
}

TEST(SendQueue, ANewPeerGetsTheMessageFromItsBeginning) {
  SendQueue queue(7, {});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(3 * kChunk_bytes));
  (void)queue.next(kAll, kNow);
  queue.sent(kNow);
  queue.start_over(Lane::kKeyframe);
  EXPECT_EQ(queue.next(kAll, kNow)->header.index, 0U);
  EXPECT_EQ(queue.next(kAll, kNow)->header.train, 1U);
}

Ack keyframes_received(std::uint32_t count) {
  Ack ack;
  ack.next_train = count + 1;
  ack.received_total = count;
  return ack;
}

TEST(SendQueue, DrainWaitsForTheLastAcknowledgement) {
  SendQueue queue(7, {});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(10));
  (void)queue.next(kAll, kNow);
  queue.sent(kNow);
  EXPECT_FALSE(queue.drain(Lane::kKeyframe, std::chrono::milliseconds(1)));
  (void)queue.on_ack(keyframes_received(1), {}, map::RobotId{2}, 100, kNow);  // another robot's: not this one
  EXPECT_FALSE(queue.drain(Lane::kKeyframe, std::chrono::milliseconds(1)));
  std::jthread receiver([&] { (void)queue.on_ack(keyframes_received(1), {}, kRobot, 100, kNow); });
  EXPECT_TRUE(queue.drain(Lane::kKeyframe, std::chrono::seconds(10)));
  EXPECT_EQ(of(queue.counters(), Lane::kKeyframe).messages_acked, 1U);
}

TEST(SendQueue, ARestartedReceiverGetsWhatIsNotAcknowledgedAndAcknowledgementsAddUp) {
  SendQueue queue(7, {});
  for (int i = 0; i < 5; ++i) {
    queue.push(Lane::kKeyframe, kRobot, message_bytes(10));
    (void)queue.next(kAll, kNow);
    queue.sent(kNow);
  }
  (void)queue.on_ack(keyframes_received(2), {}, kRobot, 100, kNow);
  (void)queue.on_ack(keyframes_received(0), {}, kRobot, 200, kNow);
  for (std::uint32_t train = 3; train <= 5; ++train) {
    const auto part = queue.next(kAll, kNow);
    ASSERT_TRUE(part.has_value());
    EXPECT_EQ(part->header.train, train);
    queue.sent(kNow);
  }
  Ack ack = keyframes_received(5);
  ack.received_total = 3;
  (void)queue.on_ack(ack, {}, kRobot, 200, kNow);
  EXPECT_EQ(of(queue.counters(), Lane::kKeyframe).messages_acked, 5U);
}

TEST(SendQueue, TheWindowIsSharedByBulkLanesAndNotByUrgentOnes) {
  SendQueue queue(7, {});
  queue.set_window(kRobot, 2 * kChunk_bytes);
  queue.push(Lane::kKeyframe, kRobot, message_bytes(5 * kChunk_bytes));
  queue.push(Lane::kSpool, kRobot, message_bytes(kChunk_bytes));
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(queue.next(kAll, kNow).has_value());
    queue.sent(kNow);
  }
  EXPECT_FALSE(queue.next(kAll, kNow).has_value());
  EXPECT_TRUE(queue.bulk_waits(kRobot));
  EXPECT_EQ(queue.bulk_bytes_on_the_way(kRobot), 2 * kChunk_bytes);
  queue.push(Lane::kRequest, kRobot, message_bytes(10));
  EXPECT_EQ(queue.next(kAll, kNow)->lane, Lane::kRequest);
}

TEST(SendQueue, TellsWhatWaitsForEachRobotAndTheMostThatEverDid) {
  SendQueue queue(7, {});
  queue.push(Lane::kDelta, kRobot, message_bytes(100));
  queue.push(Lane::kDelta, map::RobotId{2}, message_bytes(1000));
  EXPECT_EQ(queue.waiting_bytes(Lane::kDelta, kRobot), 100U);
  EXPECT_EQ(queue.waiting_bytes(Lane::kDelta, map::RobotId{2}), 1000U);
  EXPECT_EQ(queue.waiting_bytes(Lane::kKeyframe, kRobot), 0U);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(queue.next(kAll, kNow));
    queue.sent(kNow);
  }
  EXPECT_EQ(queue.waiting_bytes(Lane::kDelta, map::RobotId{2}), 0U);
  const LaneCounters delta = of(queue.counters(), Lane::kDelta);
  EXPECT_EQ(delta.queued_messages, 0U);
  EXPECT_EQ(delta.most_queued_messages, 2U);
  EXPECT_EQ(delta.most_queued_bytes, 1100U);
  EXPECT_EQ(delta.most_flying_messages, 1U);
  EXPECT_EQ(delta.most_flying_bytes, 1000U);
}

TEST(SendQueue, GivesBackOnlyWhatHasNotBegunAndCountsWhatIsUnsent) {
  SendQueue queue(7, {});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(2 * kChunk_bytes, 1));
  queue.push(Lane::kKeyframe, kRobot, message_bytes(100, 2));
  queue.push(Lane::kKeyframe, map::RobotId{2}, message_bytes(100, 3));
  queue.push(Lane::kKeyframe, kRobot, message_bytes(100, 4));
  ASSERT_TRUE(queue.next(kAll, kNow));
  queue.sent(kNow);
  EXPECT_EQ(of(queue.counters(), Lane::kKeyframe).unsent_bytes, kChunk_bytes + 300);
  const auto back = queue.withdraw(Lane::kKeyframe, kRobot);
  EXPECT_EQ(back, (std::vector{message_bytes(100, 2), message_bytes(100, 4)}));
  const LaneCounters counters = of(queue.counters(), Lane::kKeyframe);
  EXPECT_EQ(counters.messages_withdrawn, 2U);
  EXPECT_EQ(counters.queued_messages, 1U);
  EXPECT_EQ(counters.queued_bytes, 100U);
  EXPECT_EQ(counters.unsent_bytes, kChunk_bytes + 100);
}

TEST(SendQueue, CloseEndsWaiting) {
  SendQueue queue(7, {});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(10));
  std::jthread closer([&] { queue.close(); });
  EXPECT_FALSE(queue.drain(Lane::kKeyframe, std::chrono::seconds(30)));
}

}  // namespace
}  // namespace edgesplat::link
