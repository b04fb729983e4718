// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/ack.hpp"

#include "common/link/heartbeat.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace edgesplat::link {
namespace {

TEST(ReceivedTrains, SettlesInOrder) {
  ReceivedTrains trains;
  for (std::uint32_t i = 1; i <= 200; ++i) {
    EXPECT_TRUE(trains.is_new(i));
    trains.received(i);
    EXPECT_FALSE(trains.is_new(i));
  }
  EXPECT_EQ(trains.next_train(), 201U);
  EXPECT_EQ(trains.received_total(), 200U);
  EXPECT_EQ(trains.lost_total(), 0U);
}

TEST(ReceivedTrains, KeepsAGapOpenUntilItIsFilled) {
  ReceivedTrains trains;
  trains.received(2);
  trains.received(4);
  EXPECT_EQ(trains.next_train(), 1U);
  EXPECT_EQ(trains.received_bits(), 0b1010U);
  trains.received(1);
  EXPECT_EQ(trains.next_train(), 3U);
  trains.received(3);
  EXPECT_EQ(trains.next_train(), 5U);
  EXPECT_EQ(trains.received_bits(), 0U);
}

TEST(ReceivedTrains, RepetitionsCountOnce) {
  ReceivedTrains trains;
  trains.received(1);
  trains.received(1);
  trains.received(3);
  trains.received(3);
  EXPECT_EQ(trains.received_total(), 2U);
}

TEST(ReceivedTrains, GivenUpOnesAreSettledAndLost) {
  ReceivedTrains trains;
  trains.received(1);
  trains.received(3);
  trains.give_up(2);
  EXPECT_EQ(trains.next_train(), 4U);
  EXPECT_EQ(trains.lost_total(), 1U);
  EXPECT_FALSE(trains.is_new(2));
}

TEST(ReceivedTrains, PassesByWhatNeverCame) {
  ReceivedTrains trains;
  trains.received(1);
  for (std::uint32_t i = 3; i <= 100; ++i) trains.received(i);
  EXPECT_EQ(trains.lost_total(), 1U);
  EXPECT_EQ(trains.next_train(), 101U);
  trains.received(1000);  // 101..999 left out; the last 63 of them may still come
  EXPECT_EQ(trains.next_train(), 1000U - 63U);
  EXPECT_EQ(trains.lost_total(), 1U + (1000U - 63U - 101U));
}

TEST(ReceivedTrains, ALateReceiverDoesNotCountWhatWasBefore) {
  ReceivedTrains trains;
  trains.received(5000);
  EXPECT_EQ(trains.lost_total(), 0U);
  EXPECT_EQ(trains.received_total(), 1U);
}

AckReport sample_report() {
  Ack delta;
  delta.lane = Lane::kDelta;
  delta.next_train = 42;
  delta.received_bits = 0b101;
  delta.received_total = 77;
  delta.newest_train = 45;
  delta.newest_chunk = 3;
  delta.newest_attempt = 2;
  delta.newest_came_ns = -5;
  delta.partial = {{43, 2, 0b1010}, {46, 0, 0b10}};
  AckReport report;
  report.session = 0x1122334455667788ULL;
  report.delivered_bytes = 123456;
  report.sent_ns = 99;
  report.lanes = {Ack{}, delta};
  return report;
}

TEST(Ack, RoundTrip) {
  const AckReport report = sample_report();
  const auto back = decode_acks(encode_acks(report));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->session, report.session);
  EXPECT_EQ(back->delivered_bytes, 123456U);
  EXPECT_EQ(back->sent_ns, 99);
  ASSERT_EQ(back->lanes.size(), 2U);
  const Ack& delta = back->lanes[1];
  EXPECT_EQ(delta.lane, Lane::kDelta);
  EXPECT_EQ(delta.next_train, 42U);
  EXPECT_EQ(delta.received_bits, 0b101U);
  EXPECT_EQ(delta.received_total, 77U);
  EXPECT_EQ(delta.newest_train, 45U);
  EXPECT_EQ(delta.newest_chunk, 3U);
  EXPECT_EQ(delta.newest_attempt, 2U);
  EXPECT_EQ(delta.newest_came_ns, -5);
  ASSERT_EQ(delta.partial.size(), 2U);
  EXPECT_EQ(delta.partial[1].train, 46U);
  EXPECT_EQ(delta.partial[0].first_missing, 2U);
  EXPECT_EQ(delta.partial[0].came_bits, 0b1010U);
}

TEST(Ack, RefusesEveryTruncationAndEveryTail) {
  auto bytes = encode_acks(sample_report());
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_FALSE(decode_acks(std::span<const std::byte>(bytes).first(n)).has_value()) << n;
  }
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(decode_acks(bytes).has_value());
  EXPECT_FALSE(decode_acks(std::vector<std::byte>(1U << 20U)).has_value());
}

TEST(Ack, RefusesAnOlderVersionAWrongLaneAndOneNamedTwice) {
  auto bytes = encode_acks(sample_report());
  bytes[4] = std::byte{1};
  EXPECT_FALSE(decode_acks(bytes).has_value());
  bytes = encode_acks(sample_report());
  bytes[31] = std::byte{kLaneCount};  // the first lane
  EXPECT_FALSE(decode_acks(bytes).has_value());
  AckReport twice = sample_report();
  twice.lanes.push_back(twice.lanes[0]);
  EXPECT_FALSE(decode_acks(encode_acks(twice)).has_value());
}

TEST(Ack, FlippedBitsAreRefusedOrReadAsAnotherReport) {
  const auto bytes = encode_acks(sample_report());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    auto damaged = bytes;
    damaged[bit / 8] ^= std::byte{1} << (bit % 8);
    const auto back = decode_acks(damaged);
    if (back) {
      EXPECT_LE(back->lanes.size(), kLaneCount);
    }
  }
}

TEST(Heartbeat, RoundTrip) {
  Heartbeat heartbeat;
  heartbeat.epoch.value = 3;
  heartbeat.seq = 99;
  heartbeat.map_hash = 0xABCDEF0123456789ULL;
  heartbeat.mode = OffloadMode::kLean;
  heartbeat.render_p95_ms = 12.5F;
  heartbeat.memory_bytes = 1ULL << 40U;
  const auto back = decode_heartbeat(encode_heartbeat(heartbeat));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->epoch.value, 3U);
  EXPECT_EQ(back->seq, 99U);
  EXPECT_EQ(back->map_hash, heartbeat.map_hash);
  EXPECT_EQ(back->mode, OffloadMode::kLean);
  EXPECT_EQ(back->render_p95_ms, 12.5F);
  EXPECT_EQ(back->memory_bytes, heartbeat.memory_bytes);
}

TEST(Heartbeat, RefusesTruncationsAndNumbersThatAreNone) {
  Heartbeat heartbeat;
  auto bytes = encode_heartbeat(heartbeat);
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_FALSE(decode_heartbeat(std::span<const std::byte>(bytes).first(n)).has_value());
  }
  heartbeat.render_p95_ms = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(decode_heartbeat(encode_heartbeat(heartbeat)).has_value());
  bytes[4] = std::byte{9};
  bytes.push_back(std::byte{0});  // another version may have another length
  const auto other = decode_heartbeat(bytes);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().context.find("version 9, this program version 1"), std::string::npos);
}

}  // namespace
}  // namespace edgesplat::link
