// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/bounded_queue.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <set>
#include <thread>
#include <vector>

namespace edgesplat::thread {
namespace {

using namespace std::chrono_literals;

TEST(BoundedQueue, IsFirstInFirstOut) {
  BoundedQueue<int> queue({.items = 3}, Overflow::kDropNewest);
  EXPECT_EQ(queue.push(1), PushResult::kAccepted);
  EXPECT_EQ(queue.push(2), PushResult::kAccepted);
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.try_pop(), 2);
  EXPECT_EQ(queue.try_pop(), std::nullopt);
}

TEST(BoundedQueue, DropNewestRefusesAndCounts) {
  BoundedQueue<int> queue({.items = 2}, Overflow::kDropNewest);
  queue.push(1);
  queue.push(2);
  EXPECT_EQ(queue.push(3), PushResult::kDroppedNewest);
  EXPECT_EQ(queue.stats().dropped, 1U);
  EXPECT_EQ(queue.pop(), 1);
}

TEST(BoundedQueue, DropOldestMakesRoomAndCounts) {
  BoundedQueue<int> queue({.items = 2}, Overflow::kDropOldest);
  queue.push(1);
  queue.push(2);
  EXPECT_EQ(queue.push(3), PushResult::kDroppedOldest);
  EXPECT_EQ(queue.pop(), 2);
  EXPECT_EQ(queue.pop(), 3);
  const QueueStats stats = queue.stats();
  EXPECT_EQ(stats.dropped, 1U);
  EXPECT_EQ(stats.accepted, 3U);
  EXPECT_EQ(stats.most_items, 2U);
}

TEST(BoundedQueue, BytesAreALimitOfTheirOwn) {
  BoundedQueue<int> queue({.items = 100, .bytes = 10}, Overflow::kDropOldest);
  queue.push(1, 4);
  queue.push(2, 4);
  EXPECT_EQ(queue.push(3, 7), PushResult::kDroppedOldest);  // both must go: 4 + 7 > 10
  EXPECT_EQ(queue.stats().dropped, 2U);
  EXPECT_EQ(queue.stats().bytes, 7U);
  EXPECT_EQ(queue.push(4, 11), PushResult::kDroppedNewest) << "larger than the whole queue";
  EXPECT_EQ(queue.pop(), 3);
  EXPECT_EQ(queue.stats().bytes, 0U);
}

TEST(BoundedQueue, TooLargeIsRefusedAlsoWhereProducersWait) {
  BoundedQueue<int> queue({.items = 1, .bytes = 10}, Overflow::kBlock);
  EXPECT_EQ(queue.push(1, 11), PushResult::kDroppedNewest);  // waiting would last for ever
}

TEST(BoundedQueue, BlockedProducerGoesOnWhenThereIsRoom) {
  BoundedQueue<int> queue({.items = 1}, Overflow::kBlock);
  queue.push(1);
  PushResult second = PushResult::kClosed;
  std::thread producer([&] { second = queue.push(2); });
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), 2);  // waits for the producer
  producer.join();
  EXPECT_EQ(second, PushResult::kAccepted);
  EXPECT_EQ(queue.stats().dropped, 0U);
}

TEST(BoundedQueue, CloseWakesProducerAndConsumerAndKeepsWhatIsLeft) {
  BoundedQueue<int> queue({.items = 1}, Overflow::kBlock);
  queue.push(1);
  PushResult blocked = PushResult::kAccepted;
  std::thread producer([&] { blocked = queue.push(2); });
  queue.close();
  producer.join();
  EXPECT_EQ(blocked, PushResult::kClosed);
  EXPECT_FALSE(queue.finished());
  EXPECT_EQ(queue.pop(), 1);
  EXPECT_EQ(queue.pop(), std::nullopt);
  EXPECT_TRUE(queue.finished());
  EXPECT_EQ(queue.push(3), PushResult::kClosed);

  BoundedQueue<int> empty({.items = 1}, Overflow::kBlock);
  std::optional<int> got = 7;
  std::thread consumer([&] { got = empty.pop(); });
  empty.close();
  consumer.join();
  EXPECT_EQ(got, std::nullopt);
}

TEST(BoundedQueue, PopEndsOnTimeoutAndOnStop) {
  BoundedQueue<int> queue({.items = 1}, Overflow::kBlock);
  EXPECT_EQ(queue.pop_for(1ms), std::nullopt);
  EXPECT_FALSE(queue.finished());
  std::stop_source stop;
  std::optional<int> got = 7;
  std::thread consumer([&] { got = queue.pop(stop.get_token()); });
  stop.request_stop();
  consumer.join();
  EXPECT_EQ(got, std::nullopt);
  EXPECT_EQ(queue.pop_for(1h, stop.get_token()), std::nullopt);
  EXPECT_EQ(queue.pop_for(1ms, std::stop_token()), std::nullopt);
  (void)queue.push(3);
  EXPECT_EQ(queue.pop_for(1h, stop.get_token()), 3);
}

TEST(BoundedQueue, HoldsWhatCanOnlyBeMoved) {
  BoundedQueue<std::unique_ptr<int>> queue({.items = 1}, Overflow::kDropOldest);
  queue.push(std::make_unique<int>(4));
  EXPECT_EQ(**queue.pop(), 4);
}

TEST(BoundedQueue, ManyProducersAndConsumersLoseNothingWhenTheyWait) {
  constexpr int kEach = 2000;
  BoundedQueue<int> queue({.items = 4, .bytes = 10}, Overflow::kBlock);
  std::vector<std::thread> producers;
  producers.reserve(3);
  for (int p = 0; p < 3; ++p)
    producers.emplace_back([&queue, p] {
      for (int i = 0; i < kEach; ++i) queue.push(p * kEach + i, static_cast<std::size_t>(1 + i % 7));
    });
  std::vector<std::vector<int>> got(2);
  std::vector<std::thread> consumers;
  consumers.reserve(got.size());
  for (auto& items : got)
    consumers.emplace_back([&queue, &items] {
      while (auto item = queue.pop()) items.push_back(*item);
    });
  for (auto& thread : producers) thread.join();
  queue.close();
  for (auto& thread : consumers) thread.join();
  std::set<int> all(got[0].begin(), got[0].end());
  all.insert(got[1].begin(), got[1].end());
  EXPECT_EQ(all.size(), 3U * kEach);
  EXPECT_EQ(got[0].size() + got[1].size(), 3U * kEach);
  EXPECT_LE(queue.stats().most_items, 4U);
}

TEST(BoundedQueue, EveryItemIsEitherTakenOrCounted) {
  constexpr std::uint64_t kItems = 20000;
  BoundedQueue<std::uint64_t> queue({.items = 8}, Overflow::kDropOldest);
  std::uint64_t taken = 0;
  std::uint64_t last = 0;
  bool in_order = true;
  std::thread consumer([&] {
    while (auto item = queue.pop()) {
      in_order = in_order && *item > last;
      last = *item;
      ++taken;
    }
  });
  for (std::uint64_t i = 1; i <= kItems; ++i) queue.push(i);
  queue.close();
  consumer.join();
  EXPECT_TRUE(in_order);
  EXPECT_EQ(last, kItems) << "the newest item must survive";
  EXPECT_EQ(taken + queue.stats().dropped, kItems);
}

}  // namespace
}  // namespace edgesplat::thread
