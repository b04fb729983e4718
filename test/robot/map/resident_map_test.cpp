// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/map/resident_map.hpp"

#include "common/map/delta_codec.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>

namespace edgesplat::map {
namespace {

constexpr std::size_t kRows = 20;

struct Stamp {
  std::uint32_t epoch = 1;
  std::uint64_t seq = 1;
  std::uint16_t robot = 1;
  std::uint8_t map = 1;
};

std::vector<std::byte> add_delta(const Stamp& stamp) {
  Delta delta;
  delta.header.robot.value = stamp.robot;
  delta.header.map.bytes.fill(static_cast<std::byte>(stamp.map));
  delta.header.epoch.value = stamp.epoch;
  delta.header.seq = stamp.seq;
  delta.header.base_seq = stamp.seq - 1;
  AddBody body{test::random_rows(kRows, stamp.seq)};
  for (std::size_t i = 0; i < kRows; ++i) {
    body.rows.ids[i] = gaussian::GaussianId(40000, stamp.epoch * 1000000 + stamp.seq * 1000 + i);
    body.rows.chunks[i] = {static_cast<std::int32_t>(i % 3), 0, 0};
  }
  delta.body = std::move(body);
  return *encode_delta(delta);
}

HostTime at_s(double seconds) {
  return HostTime(from_seconds(seconds));
}

TEST(ResidentMap, BeginsEmptyWithASnapshot) {
  const ResidentMap map(ResidentMapConfig{});
  ASSERT_NE(map.snapshot(), nullptr);
  EXPECT_EQ(map.snapshot()->size(), 0U);
  EXPECT_EQ(map.map_from_odom().version, 0U);
}

TEST(ResidentMap, AppliesInOrderAndPublishes) {
  ResidentMap map(ResidentMapConfig{});
  for (std::uint64_t seq = 1; seq <= 5; ++seq) {
    EXPECT_EQ(map.apply(add_delta({1, seq}), at_s(static_cast<double>(seq))), ApplyOutcome::kApplied);
    EXPECT_EQ(map.snapshot()->size(), seq * kRows);
    EXPECT_TRUE(map.snapshot()->consistent());
  }
  EXPECT_EQ(map.position().seq, 5U);
  EXPECT_EQ(map.counters().gaussians, 5 * kRows);
}

TEST(ResidentMap, ADuplicateChangesNothing) {
  ResidentMap map(ResidentMapConfig{});
  (void)map.apply(add_delta({1, 1}), at_s(0));
  (void)map.apply(add_delta({1, 2}), at_s(1));
  const std::uint64_t before = map.map_hash();
  EXPECT_EQ(map.apply(add_delta({1, 1}), at_s(2)), ApplyOutcome::kDuplicate);
  EXPECT_EQ(map.apply(add_delta({1, 2}), at_s(3)), ApplyOutcome::kDuplicate);
  EXPECT_EQ(map.map_hash(), before);
  EXPECT_EQ(map.counters().gaussians, 2 * kRows);
}

TEST(ResidentMap, AnyOrderAndRepetitionEndInTheSameMap) {
  ResidentMap straight(ResidentMapConfig{});
  for (std::uint64_t seq = 1; seq <= 30; ++seq) (void)straight.apply(add_delta({1, seq}), at_s(0));
  std::mt19937 random(5);
  for (int round = 0; round < 10; ++round) {
    std::vector<std::uint64_t> order;
    for (std::uint64_t seq = 2; seq <= 30; ++seq) order.insert(order.end(), 1 + random() % 2, seq);
    std::shuffle(order.begin(), order.end(), random);
    ResidentMap map(ResidentMapConfig{});
    (void)map.apply(add_delta({1, 1}), at_s(0));
    for (const std::uint64_t seq : order) (void)map.apply(add_delta({1, seq}), at_s(0));
    EXPECT_EQ(map.position().seq, 30U);
    EXPECT_EQ(map.map_hash(), straight.map_hash());
    EXPECT_EQ(map.counters().gaussians, 30 * kRows);
    EXPECT_EQ(map.counters().held_now, 0U);
  }
}

TEST(ResidentMap, HoldsAtMostItsLimit) {
  ResidentMapConfig config;
  config.max_held_deltas = 4;
  ResidentMap map(config);
  (void)map.apply(add_delta({1, 1}), at_s(0));
  for (std::uint64_t seq = 3; seq < 7; ++seq)
    EXPECT_EQ(map.apply(add_delta({1, seq}), at_s(0)), ApplyOutcome::kHeld);
  EXPECT_EQ(map.apply(add_delta({1, 7}), at_s(0)), ApplyOutcome::kNeedsReset);
  EXPECT_EQ(map.counters().held_now, 4U);
  EXPECT_EQ(map.apply(add_delta({1, 2}), at_s(0)), ApplyOutcome::kApplied);
  EXPECT_EQ(map.position().seq, 6U);
}

TEST(ResidentMap, ANewEpochBeginsAnEmptyMap) {
  ResidentMap map(ResidentMapConfig{});
  (void)map.apply(add_delta({1, 1}), at_s(0));
  (void)map.apply(add_delta({1, 2}), at_s(0));
  EXPECT_EQ(map.apply(add_delta({2, 5, 1, 9}), at_s(1)), ApplyOutcome::kNeedsReset);  // not its beginning
  EXPECT_EQ(map.position().epoch, Epoch{1});
  EXPECT_EQ(map.apply(add_delta({2, 1, 1, 9}), at_s(1)), ApplyOutcome::kApplied);
  EXPECT_EQ(map.position().epoch, Epoch{2});
  EXPECT_EQ(map.counters().gaussians, kRows);
  EXPECT_EQ(map.apply(add_delta({1, 3}), at_s(2)), ApplyOutcome::kOldEpoch);
  EXPECT_EQ(map.counters().gaussians, kRows);
  EXPECT_EQ(map.counters().resets, 1U);
}

TEST(ResidentMap, RefusesWhatIsCorruptForeignOrOfAnotherMap) {
  ResidentMap map(ResidentMapConfig{});
  (void)map.apply(add_delta({1, 1}), at_s(0));
  const std::uint64_t before = map.map_hash();
  auto bytes = add_delta({1, 2});
  bytes[100] ^= std::byte{1};
  EXPECT_EQ(map.apply(bytes, at_s(0)), ApplyOutcome::kCorrupt);
  EXPECT_EQ(map.apply({}, at_s(0)), ApplyOutcome::kCorrupt);
  EXPECT_EQ(map.apply(add_delta({1, 2, 77}), at_s(0)), ApplyOutcome::kForeign);     // another robot's
  EXPECT_EQ(map.apply(add_delta({1, 2, 1, 99}), at_s(0)), ApplyOutcome::kForeign);  // another map's
  EXPECT_EQ(map.map_hash(), before);
  EXPECT_EQ(map.counters().corrupt, 2U);
  EXPECT_EQ(map.counters().foreign, 2U);
  EXPECT_EQ(map.apply(add_delta({1, 2}), at_s(0)), ApplyOutcome::kApplied);
}

TEST(ResidentMap, SnapshotsComeNoFasterThanThePeriodAndNoneIsForgotten) {
  ResidentMapConfig config;
  config.publish_period_s = 0.5;
  ResidentMap map(config);
  for (int i = 0; i < 100; ++i)
    (void)map.apply(add_delta({1, static_cast<std::uint64_t>(i + 1)}), at_s(i * 0.01));
  EXPECT_LE(map.counters().snapshots, 3U);
  EXPECT_LT(map.snapshot()->size(), 100 * kRows);
  map.publish_if_due(at_s(5.0));
  EXPECT_EQ(map.snapshot()->size(), 100 * kRows);
  const auto same = map.snapshot();
  map.publish_if_due(at_s(10.0));
  EXPECT_EQ(map.snapshot(), same);  // nothing changed: nothing copied
}

TEST(ResidentMap, AHeldSnapshotStaysAsItWas) {
  ResidentMap map(ResidentMapConfig{});
  (void)map.apply(add_delta({1, 1}), at_s(0));
  const auto old = map.snapshot();
  const auto means_m = old->means_m;
  (void)map.apply(add_delta({1, 2}), at_s(1));
  EXPECT_EQ(old->means_m, means_m);
  EXPECT_NE(map.snapshot(), old);
}

TEST(ResidentMap, TheRendererReadsWhileDeltasCome) {
  ResidentMapConfig config;
  config.publish_period_s = 0.0;
  ResidentMap map(config);
  std::jthread renderer([&map](const std::stop_token& stop) {
    std::size_t last = 0;
    while (!stop.stop_requested()) {
      const auto snapshot = map.snapshot();
      EXPECT_TRUE(snapshot->consistent());
      EXPECT_GE(snapshot->size(), last);
      last = snapshot->size();
      (void)map.map_hash();
    }
  });
  for (std::uint64_t seq = 1; seq <= 200; ++seq) (void)map.apply(add_delta({1, seq}), at_s(0));
  renderer.request_stop();
}

std::vector<std::byte> mapped_delta(std::uint64_t seq, std::vector<std::uint32_t> keyframes) {
  Delta delta = *decode_delta(add_delta({1, seq}));
  delta.body = MappedBody{std::move(keyframes)};
  return *encode_delta(delta);
}

TEST(ResidentMap, MappedKeyframesAreHandedOnWithTheSnapshotThatHasThem) {
  ResidentMapConfig config;
  config.publish_period_s = 0.5;
  ResidentMap map(config);
  (void)map.apply(add_delta({1, 1}), at_s(0));  // published
  (void)map.apply(add_delta({1, 2}), at_s(0.1));
  (void)map.apply(mapped_delta(3, {7, 8}), at_s(0.1));
  EXPECT_TRUE(map.take_mapped().empty());
  (void)map.apply(mapped_delta(4, {9}), at_s(0.7));
  EXPECT_EQ(map.snapshot()->size(), 2 * kRows);
  EXPECT_EQ(map.take_mapped(), (std::vector<std::uint32_t>{7, 8, 9}));
  EXPECT_TRUE(map.take_mapped().empty());
  (void)map.apply(mapped_delta(5, {10}), at_s(0.8));
  map.publish_now(at_s(0.8));
  EXPECT_EQ(map.take_mapped(), std::vector<std::uint32_t>{10});
}

TEST(ResidentMap, WhatWasMappedBeforeAResetWaitsForTheNewMapToSaySo) {
  ResidentMapConfig config;
  config.publish_period_s = 0.5;
  ResidentMap map(config);
  (void)map.apply(add_delta({1, 1}), at_s(0));
  (void)map.apply(mapped_delta(2, {7}), at_s(0.1));
  (void)map.apply(add_delta({2, 1, 1, 9}), at_s(0.2));
  map.publish_now(at_s(0.3));
  EXPECT_TRUE(map.take_mapped().empty());
}

}  // namespace
}  // namespace edgesplat::map
