// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/receive_side.hpp"

#include "common/link/send_queue.hpp"
#include "test/support/message_bytes.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

namespace edgesplat::link {
namespace {

using test::message_bytes;

constexpr map::RobotId kRobot{3};

struct Chunk {
  Lane lane;
  ChunkHeader header;
  std::vector<std::byte> payload;
};

/// All chunks of `messages` as a sender would put them on the network.
std::vector<Chunk> sent(const std::vector<std::vector<std::byte>>& messages, std::uint64_t session = 7) {
  FlightLimits flight;
  flight.trains = 1000;
  SendQueue queue(session, {1000, 64U << 20U, flight});
  queue.set_window(kRobot, std::size_t{64} << 20U);
  for (const auto& message : messages) queue.push(Lane::kDelta, kRobot, message);
  std::vector<Chunk> chunks;
  while (const auto part = queue.next(kAllLanes, HostTime{})) {
    chunks.push_back({part->lane, part->header, {part->payload.begin(), part->payload.end()}});
    queue.sent(HostTime{});
  }
  return chunks;
}

const LaneCounters& deltas(const LinkCounters& counters) {
  return counters[static_cast<std::size_t>(Lane::kDelta)];
}

TEST(ReceiveSide, LossDuplicationAndReorderingNeverGiveAMessageTwiceOrWrong) {
  std::mt19937 random(11);
  std::vector<std::vector<std::byte>> messages;
  for (std::uint32_t i = 0; i < 40; ++i) messages.push_back(message_bytes(1000 + random() % 200000, i));
  for (const double loss : {0.0, 0.05, 0.2}) {
    auto chunks = sent(messages);
    std::vector<Chunk> on_the_way;
    for (const Chunk& chunk : chunks) {
      const double dice = static_cast<double>(random() % 10000) / 10000.0;
      if (dice < loss) continue;
      on_the_way.push_back(chunk);
      if (dice > 0.9) on_the_way.push_back(chunk);
    }
    for (std::size_t i = 0; i + 8 < on_the_way.size(); i += 4) {
      std::shuffle(on_the_way.begin() + static_cast<std::ptrdiff_t>(i),
                   on_the_way.begin() + static_cast<std::ptrdiff_t>(i + 8), random);
    }
    ReceiveSide side;
    std::vector<int> times(messages.size(), 0);
    for (const Chunk& chunk : on_the_way) {
      if (auto message = side.add(chunk.lane, chunk.header, chunk.payload, HostTime{})) {
        const auto found = std::find(messages.begin(), messages.end(), message->bytes);
        ASSERT_NE(found, messages.end());
        ++times[static_cast<std::size_t>(found - messages.begin())];
      }
    }
    EXPECT_THAT(times, ::testing::Each(::testing::Le(1)));
    if (loss == 0.0) {
      EXPECT_THAT(times, ::testing::Each(1));
    }
    side.expire(HostTime(std::chrono::seconds(60)));
    const auto due = side.take_due_acks(HostTime{});
    ASSERT_FALSE(due.empty());
    EXPECT_EQ(due[0].report.lanes[0].received_total, deltas(side.counters()).messages_received);
  }
}

TEST(ReceiveSide, AcksTellEveryChunk) {
  ReceiveSide side;
  const auto chunks = sent({message_bytes(3 * kChunk_bytes)});
  const HostTime now(std::chrono::seconds(5));
  EXPECT_FALSE(side.add(Lane::kDelta, chunks[0].header, chunks[0].payload, now).has_value());
  EXPECT_FALSE(side.add(Lane::kDelta, chunks[2].header, chunks[2].payload, now).has_value());
  auto due = side.take_due_acks(now + std::chrono::milliseconds(3));
  ASSERT_EQ(due.size(), 1U);
  EXPECT_EQ(due[0].robot, kRobot);
  EXPECT_EQ(due[0].report.session, 7U);
  EXPECT_EQ(due[0].report.delivered_bytes, 2 * kChunk_bytes);
  ASSERT_EQ(due[0].report.lanes.size(), 1U);
  const Ack ack = due[0].report.lanes[0];
  EXPECT_EQ(ack.newest_train, 1U);
  EXPECT_EQ(ack.newest_chunk, 2U);
  EXPECT_EQ(due[0].report.sent_ns - ack.newest_came_ns, 3'000'000);
  ASSERT_EQ(ack.partial.size(), 1U);
  EXPECT_EQ(ack.partial[0].first_missing, 1U);
  EXPECT_EQ(ack.partial[0].came_bits, 0b10U);
  EXPECT_TRUE(side.take_due_acks(now).empty());
  EXPECT_TRUE(side.add(Lane::kDelta, chunks[1].header, chunks[1].payload, now).has_value());
  due = side.take_due_acks(now);
  ASSERT_EQ(due.size(), 1U);
  EXPECT_EQ(due[0].report.lanes[0].next_train, 2U);
  EXPECT_TRUE(due[0].report.lanes[0].partial.empty());
}

TEST(ReceiveSide, OneFlippedBitCostsOneChunk) {
  ReceiveSide side;
  const auto chunks = sent({message_bytes(3 * kChunk_bytes)});
  for (const Chunk& chunk : chunks) {
    auto damaged = chunk.payload;
    damaged[damaged.size() / 2] ^= std::byte{0x10};
    EXPECT_FALSE(side.add(Lane::kDelta, chunk.header, damaged, HostTime{}).has_value());
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(side.add(Lane::kDelta, chunks[i].header, chunks[i].payload, HostTime{}).has_value(), i == 2);
  }
  EXPECT_EQ(deltas(side.counters()).chunks_corrupt, 3U);
  EXPECT_EQ(deltas(side.counters()).messages_corrupt, 0U);
}

TEST(ReceiveSide, ARestartedSenderStartsAfresh) {
  ReceiveSide side;
  for (const std::uint64_t session : {7U, 8U}) {
    for (const Chunk& chunk : sent({message_bytes(100)}, session)) {
      const auto message = side.add(Lane::kDelta, chunk.header, chunk.payload, HostTime{});
      ASSERT_TRUE(message.has_value());
      EXPECT_EQ(message->session, session);
    }
  }
}

TEST(ReceiveSide, RemembersABoundedNumberOfSenders) {
  ReceiveLimits limits;
  limits.senders = 4;
  ReceiveSide side(limits);
  for (std::uint64_t session = 1; session <= 50; ++session) {
    const auto chunks = sent({message_bytes(2 * kChunk_bytes)}, session);
    (void)side.add(Lane::kDelta, chunks[0].header, chunks[0].payload,
                   HostTime(std::chrono::milliseconds(session)));
  }
  EXPECT_EQ(deltas(side.counters()).messages_lost, 46U);
}

TEST(ReceiveSide, CountsCorruptSingles) {
  ReceiveSide side;
  ChunkHeader header{kRobot, 7, 1, 0, 1, 4, 0xDEADBEEFU, 1, 0};
  const std::vector<std::byte> payload(4);
  EXPECT_FALSE(side.add(Lane::kHeartbeat, header, payload, HostTime{}).has_value());
  EXPECT_EQ(side.counters()[index_of(Lane::kHeartbeat)].chunks_corrupt, 1U);
  header.chunk_crc32c = chunk_crc32c(header, payload);
  EXPECT_FALSE(side.add(Lane::kHeartbeat, header, payload, HostTime{}).has_value());
  EXPECT_EQ(side.counters()[index_of(Lane::kHeartbeat)].messages_corrupt, 1U);
}

}  // namespace
}  // namespace edgesplat::link
