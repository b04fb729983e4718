// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/flight.hpp"

#include "test/support/message_bytes.hpp"

#include <gtest/gtest.h>

namespace edgesplat::link {
namespace {

using namespace std::chrono_literals;
using test::message_bytes;

constexpr std::size_t kWide = 1U << 24U;

class FlightTest : public ::testing::Test {
 protected:
  void begin(Flight& flight, std::uint32_t train, std::size_t chunks) {
    ChunkHeader header;
    header.train = train;
    header.count = static_cast<std::uint32_t>(chunks);
    header.total_bytes = static_cast<std::uint32_t>(chunks * kChunk_bytes);
    flight.begin(header, message_bytes(header.total_bytes, train));
  }
  /// Sends all there is, a millisecond apart; the chunks' indices.
  std::vector<std::uint32_t> send_all(Flight& flight) {
    std::vector<std::uint32_t> indices;
    while (const auto part = flight.next(now_, kWide)) {
      indices.push_back(part->header.index);
      (void)flight.sent(now_);
      now_ += 1ms;
    }
    return indices;
  }
  /// Of train 1, chunks with a bit in `came`.
  static Ack partly(std::uint64_t came, std::uint32_t newest, std::uint32_t attempt = 1) {
    Ack ack;
    ack.newest_train = 1;
    ack.newest_chunk = newest;
    ack.newest_attempt = attempt;
    PartialTrain part;
    part.train = 1;
    while ((came >> part.first_missing & 1U) != 0) ++part.first_missing;
    part.came_bits = came >> part.first_missing;
    ack.partial = {part};
    return ack;
  }
  static Ack whole(std::uint32_t next_train) {
    Ack ack;
    ack.next_train = next_train;
    return ack;
  }

  HostTime now_{HostTime(10s)};
};

TEST_F(FlightTest, HolesAreSentAgainAndNothingElse) {
  Flight flight;
  begin(flight, 1, 6);
  EXPECT_EQ(send_all(flight), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  now_ += 40ms;
  auto news = flight.on_ack(partly(0b001101, 3), 0ns, now_);
  EXPECT_EQ(news.chunks_came, 3U);
  EXPECT_EQ(news.chunks_lost, 0U);  // 1 was sent only 2 ms before 3: may have been overtaken
  begin(flight, 2, 1);
  now_ += 40ms;
  EXPECT_EQ(send_all(flight), (std::vector<std::uint32_t>{1, 0}));  // by now it is lost
  now_ += 60ms;
  Ack ack = partly(0b001101, 3);
  ack.received_bits = 0b10;  // train 2, sent long after 4 and 5, is there
  news = flight.on_ack(ack, 0ns, now_);
  EXPECT_EQ(news.chunks_lost, 3U);
  EXPECT_EQ(send_all(flight), (std::vector<std::uint32_t>{4, 5}));
  EXPECT_EQ(flight.resent(), 3U);
  (void)flight.on_ack(whole(3), 0ns, now_);
  EXPECT_TRUE(flight.empty());
  EXPECT_EQ(flight.bytes_on_the_way(), 0U);
  EXPECT_EQ(flight.held_bytes(), 0U);
}

TEST_F(FlightTest, SilenceSendsTheOldestAgainEverMoreSeldomAndAtLastGivesUp) {
  FlightLimits limits;
  limits.tries = 4;
  Flight flight(limits);
  begin(flight, 1, 2);
  (void)send_all(flight);
  std::vector<double> gaps_s;
  HostTime last = now_;
  while (!flight.empty() && gaps_s.size() < 20) {
    const auto due = flight.next_timeout();
    now_ = due.value_or(now_);
    if (send_all(flight).empty()) continue;
    gaps_s.push_back(to_seconds(now_ - last));
    last = now_;
  }
  EXPECT_EQ(gaps_s.size(), 3U);
  EXPECT_GT(gaps_s[1], 1.8 * gaps_s[0]);
  EXPECT_EQ(flight.given_up(), 1U);
  EXPECT_EQ(flight.bytes_on_the_way(), 0U);
}

TEST_F(FlightTest, TheWindowHoldsNewChunksBackButNeverTheFirst) {
  Flight flight;
  begin(flight, 1, 5);
  EXPECT_FALSE(flight.next(now_, 0).has_value());
  ASSERT_TRUE(flight.next(now_, 1).has_value());
  (void)flight.sent(now_);
  EXPECT_FALSE(flight.next(now_, 2 * kChunk_bytes - 1).has_value());
  EXPECT_TRUE(flight.next(now_, 2 * kChunk_bytes).has_value());
}

TEST_F(FlightTest, RoundTripIsOfTheSendingThatCameWithoutTheReceiversTime) {
  Flight flight;
  begin(flight, 1, 2);
  (void)send_all(flight);
  now_ = HostTime(10s) + 30ms;
  const auto news = flight.on_ack(partly(0b01, 0), 10ms, now_);
  ASSERT_TRUE(news.round_trip.has_value());
  EXPECT_EQ(*news.round_trip, 20ms);
  EXPECT_EQ(*news.newest_sent, HostTime(10s));
  now_ = *flight.next_timeout();
  const HostTime again = now_;
  EXPECT_EQ(send_all(flight), (std::vector<std::uint32_t>{1}));
  now_ = again + 25ms;
  EXPECT_EQ(*flight.on_ack(partly(0b01, 1, 1), 5ms, now_).round_trip, now_ - 5ms - (HostTime(10s) + 1ms));
  EXPECT_EQ(*flight.on_ack(partly(0b01, 1, 2), 5ms, now_).round_trip, 20ms);
}

TEST_F(FlightTest, ANewReceiverGetsEverythingAgain) {
  Flight flight;
  begin(flight, 1, 3);
  (void)send_all(flight);
  (void)flight.on_ack(partly(0b011, 1), 0ns, now_);
  flight.start_over();
  EXPECT_EQ(send_all(flight), (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST_F(FlightTest, NonsenseFromThePeerDoesNoHarm) {
  Flight flight;
  begin(flight, 1, 3);
  Ack ack = partly(~std::uint64_t{0} >> 1U, 77);
  ack.partial.push_back({1, 0xFFFFFFFFU, ~std::uint64_t{0}});
  ack.partial.push_back({99, 0, ~std::uint64_t{0}});
  ack.next_train = 1000;
  EXPECT_EQ(flight.on_ack(ack, 0ns, now_).chunks_came, 0U);  // nothing was sent yet
  EXPECT_EQ(send_all(flight).size(), 3U);
  EXPECT_EQ(flight.on_ack(ack, 0ns, now_).chunks_came, 3U);
  EXPECT_TRUE(flight.empty());
}

}  // namespace
}  // namespace edgesplat::link
