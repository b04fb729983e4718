// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/send_queue.hpp"

#include "test/support/message_bytes.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace edgesplat::link {
namespace {

using test::message_bytes;

constexpr LaneMask kAll = {true, true, true, true, true};
constexpr map::RobotId kRobot{1};

const LaneCounters& of(const LinkCounters& counters, Lane lane) {
  return counters[static_cast<std::size_t>(lane)];
}

TEST(SendQueue, UrgentLanesOvertakeATrainBetweenItsChunks) {
  SendQueue queue(7, {});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(3 * kChunk_bytes));
  ASSERT_EQ(queue.next(kAll)->lane, Lane::kKeyframe);
  queue.advance(Lane::kKeyframe);
  queue.push(Lane::kHeartbeat, kRobot, message_bytes(10));
  ASSERT_EQ(queue.next(kAll)->lane, Lane::kHeartbeat);
  queue.advance(Lane::kHeartbeat);
  const auto part = queue.next(kAll);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->lane, Lane::kKeyframe);
  EXPECT_EQ(part->header.index, 1U);
  EXPECT_EQ(part->header.train, 1U);
}

TEST(SendQueue, UnreachableLanesWait) {
  SendQueue queue(7, {});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(10));
  EXPECT_FALSE(queue.next(LaneMask{}).has_value());
  EXPECT_TRUE(queue.next(kAll).has_value());
}

TEST(SendQueue, AFullLaneDropsItsOldestAndNeverWhatIsUnderWay) {
  SendQueue queue(7, {3, 1U << 20U});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(2 * kChunk_bytes, 0));
  (void)queue.next(kAll);
  queue.advance(Lane::kKeyframe);
  for (std::uint32_t i = 1; i <= 10; ++i)
    EXPECT_TRUE(queue.push(Lane::kKeyframe, kRobot, message_bytes(10, i)));
  const auto counters = queue.counters();
  EXPECT_EQ(of(counters, Lane::kKeyframe).queued_messages, 3U);
  EXPECT_EQ(of(counters, Lane::kKeyframe).messages_dropped, 8U);
  EXPECT_EQ(queue.next(kAll)->header.index, 1U);  // still the first train
  queue.advance(Lane::kKeyframe);
  const auto part = queue.next(kAll);
  EXPECT_EQ(part->header.train, 2U);  // what was shed leaves no gap in the numbers
  const auto ninth = message_bytes(10, 9);
  EXPECT_TRUE(std::equal(part->payload.begin(), part->payload.end(), ninth.begin(), ninth.end()));
}

TEST(SendQueue, BytesAreBoundedToo) {
  SendQueue queue(7, {1000, 1000});
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

TEST(SendQueue, RewindStartsTheMessageOver) {
  SendQueue queue(7, {});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(3 * kChunk_bytes));
  (void)queue.next(kAll);
  queue.advance(Lane::kKeyframe);
  queue.rewind(Lane::kKeyframe);
  EXPECT_EQ(queue.next(kAll)->header.index, 0U);
  EXPECT_EQ(queue.next(kAll)->header.train, 1U);
}

TEST(SendQueue, DrainWaitsForTheLastAcknowledgement) {
  SendQueue queue(7, {});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(10));
  (void)queue.next(kAll);
  queue.advance(Lane::kKeyframe);
  EXPECT_FALSE(queue.drain(Lane::kKeyframe, std::chrono::milliseconds(1)));
  queue.on_ack(Ack{Lane::kKeyframe, 8, 2, 0, 1}, kRobot, 100);  // another session's: not ours
  EXPECT_FALSE(queue.drain(Lane::kKeyframe, std::chrono::milliseconds(1)));
  std::jthread receiver([&] { queue.on_ack(Ack{Lane::kKeyframe, 7, 2, 0, 1}, kRobot, 100); });
  EXPECT_TRUE(queue.drain(Lane::kKeyframe, std::chrono::seconds(10)));
  EXPECT_EQ(of(queue.counters(), Lane::kKeyframe).messages_acked, 1U);
}

TEST(SendQueue, AcknowledgementsAddUpOverARestartOfTheReceiver) {
  SendQueue queue(7, {});
  for (int i = 0; i < 5; ++i) {
    queue.push(Lane::kKeyframe, kRobot, message_bytes(10));
    (void)queue.next(kAll);
    queue.advance(Lane::kKeyframe);
  }
  queue.on_ack(Ack{Lane::kKeyframe, 7, 3, 0, 2}, kRobot, 100);
  queue.on_ack(Ack{Lane::kKeyframe, 7, 1, 0, 3}, kRobot, 200);
  EXPECT_EQ(of(queue.counters(), Lane::kKeyframe).messages_acked, 5U);
}

TEST(SendQueue, CloseEndsWaiting) {
  SendQueue queue(7, {});
  queue.push(Lane::kKeyframe, kRobot, message_bytes(10));
  std::jthread closer([&] { queue.close(); });
  EXPECT_FALSE(queue.drain(Lane::kKeyframe, std::chrono::seconds(30)));
}

}  // namespace
}  // namespace edgesplat::link
