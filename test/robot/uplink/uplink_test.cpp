// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/uplink.hpp"

#include "common/link/in_process_transport.hpp"
#include "common/map/keyframe_codec.hpp"
#include "robot/uplink/downlink.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <atomic>
#include <condition_variable>
#include <limits>
#include <mutex>

namespace edgesplat::uplink {
namespace {

constexpr nanoseconds kPatience = std::chrono::seconds(20);
constexpr map::RobotId kRobot{1};

std::shared_ptr<const map::Keyframe> keyframe(std::uint32_t id, std::size_t points = 100) {
  return std::make_shared<const map::Keyframe>(test::random_keyframe(id, points, id));
}

/// A transport whose send() does not return until it is told to: the worst a link could do to the uplink's
/// thread.
class StuckTransport final : public link::Transport {
 public:
  bool send(link::Lane lane, map::RobotId, std::vector<std::byte>) override {
    if (lane != link::Lane::kKeyframe) return true;
    std::unique_lock lock(mutex_);
    stuck_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return released_; });
    return true;
  }
  std::optional<link::Message> receive(nanoseconds) override { return std::nullopt; }
  [[nodiscard]] bool connected() const override { return false; }
  [[nodiscard]] link::LinkCounters counters() const override { return {}; }
  bool drain(link::Lane, nanoseconds) override { return false; }
  void close() override {}
  [[nodiscard]] bool finished() const override { return false; }

  void wait_until_stuck() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stuck_; });
  }
  void release() {
    const std::lock_guard lock(mutex_);
    released_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stuck_ = false;
  bool released_ = false;
};

TEST(Uplink, KeyframesArriveDecodableAndInOrder) {
  const SteadyClock clock;
  const auto link = link::make_in_process_link(kRobot);
  Uplink uplink(UplinkConfig{}, *link.robot, clock);
  for (std::uint32_t id = 1; id <= 10; ++id) EXPECT_TRUE(uplink.submit(keyframe(id)));
  ASSERT_TRUE(uplink.drain(kPatience));
  std::uint32_t next = 1;
  while (const auto message = link.server->receive(nanoseconds(0))) {
    if (message->lane != link::Lane::kKeyframe) continue;
    const auto decoded = map::decode_keyframe(message->bytes);
    ASSERT_TRUE(decoded.has_value());
    EXPECT_EQ(decoded->id.value, next++);
  }
  EXPECT_EQ(next, 11U);
  EXPECT_EQ(uplink.counters().handed_on, 10U);
  EXPECT_GT(uplink.counters().encoded_bytes, 0U);
}

TEST(Uplink, AStuckLinkNeverHoldsTheCallerAndTheOldestGo) {
  const SteadyClock clock;
  StuckTransport transport;
  UplinkConfig config;
  config.queue_keyframes = 4;
  Uplink uplink(config, transport, clock);
  (void)uplink.submit(keyframe(0));
  transport.wait_until_stuck();
  nanoseconds slowest{0};
  for (std::uint32_t id = 1; id <= 100; ++id) {
    const auto frame = keyframe(id);
    const HostTime before = clock.now();
    EXPECT_EQ(uplink.submit(frame), id <= 4);
    slowest = std::max(slowest, clock.now() - before);
  }
  EXPECT_LT(slowest, std::chrono::milliseconds(20));
  const UplinkCounters counters = uplink.counters();
  EXPECT_EQ(counters.submitted, 101U);
  EXPECT_EQ(counters.dropped, 96U);
  transport.release();
}

TEST(Uplink, WhatCannotBeEncodedIsCounted) {
  const SteadyClock clock;
  const auto link = link::make_in_process_link(kRobot);
  Uplink uplink(UplinkConfig{}, *link.robot, clock);
  auto bad = test::random_keyframe(1, 3, 1);
  bad.points_in_body[0].p_in_body_m.x() = std::numeric_limits<float>::quiet_NaN();
  (void)uplink.submit(std::make_shared<const map::Keyframe>(bad));
  ASSERT_TRUE(uplink.drain(kPatience));
  EXPECT_EQ(uplink.counters().refused, 1U);
  EXPECT_EQ(uplink.counters().handed_on, 0U);
}

TEST(Uplink, HeartbeatsCarryWhatTheSourceSays) {
  const SteadyClock clock;
  const auto link = link::make_in_process_link(kRobot);
  UplinkConfig config;
  config.heartbeat_period_s = 0.05;
  Uplink uplink(config, *link.robot, clock, [] {
    link::Heartbeat heartbeat;
    heartbeat.seq = 42;
    return heartbeat;
  });
  for (int i = 0; i < 3; ++i) {
    const auto message = link.server->receive(kPatience);
    ASSERT_TRUE(message.has_value());
    ASSERT_EQ(message->lane, link::Lane::kHeartbeat);
    EXPECT_EQ(link::decode_heartbeat(message->bytes)->seq, 42U);
  }
}

/// Numbers of the keyframes that came on a lane so far.
std::vector<std::uint32_t> came(link::Transport& server, link::Lane lane, std::size_t count) {
  std::vector<std::uint32_t> ids;
  while (ids.size() < count) {
    const auto message = server.receive(kPatience);
    if (!message) break;
    if (message->lane == lane) ids.push_back(map::decode_keyframe(message->bytes)->id.value);
  }
  return ids;
}

TEST(Uplink, LeanSendsEveryThirdAndTheOthersFollowWhenTheLinkIsIdle) {
  const SteadyClock clock;
  const auto link = link::make_in_process_link(kRobot);
  Uplink uplink(UplinkConfig{}, *link.robot, clock);
  uplink.set_mode(link::OffloadMode::kLean);
  for (std::uint32_t id = 1; id <= 9; ++id) (void)uplink.submit(keyframe(id));
  EXPECT_EQ(came(*link.server, link::Lane::kKeyframe, 3), (std::vector<std::uint32_t>{1, 4, 7}));
  auto others = came(*link.server, link::Lane::kSpool, 6);  // newest first of those that wait just then
  std::sort(others.begin(), others.end());
  EXPECT_EQ(others, (std::vector<std::uint32_t>{2, 3, 5, 6, 8, 9}));
  EXPECT_EQ(uplink.counters().kept_by_mode, 6U);
}

TEST(Uplink, LocalKeepsAllAndFullSendsThemNewestFirst) {
  const SteadyClock clock;
  const auto link = link::make_in_process_link(kRobot);
  Uplink uplink(UplinkConfig{}, *link.robot, clock);
  uplink.set_mode(link::OffloadMode::kLocal);
  for (std::uint32_t id = 1; id <= 5; ++id) (void)uplink.submit(keyframe(id));
  EXPECT_FALSE(uplink.drain(std::chrono::milliseconds(300)));
  EXPECT_EQ(uplink.counters().spool.items, 5U);
  EXPECT_EQ(uplink.counters().handed_on, 0U);
  uplink.set_mode(link::OffloadMode::kFull);
  EXPECT_TRUE(uplink.drain(kPatience));
  EXPECT_EQ(came(*link.server, link::Lane::kSpool, 5), (std::vector<std::uint32_t>{5, 4, 3, 2, 1}));
  EXPECT_EQ(uplink.counters().spool.items, 0U);
}

TEST(Downlink, HandsDeltasAndHeartbeatsToTheirTakers) {
  const auto link = link::make_in_process_link(kRobot);
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::size_t> deltas;
  std::uint64_t seq = 0;
  bool idle = false;
  DownlinkHandlers handlers;
  handlers.on_delta = [&](std::span<const std::byte> bytes) {
    const std::lock_guard lock(mutex);
    deltas.push_back(bytes.size());
  };
  handlers.on_heartbeat = [&](const link::Heartbeat& heartbeat) {
    const std::lock_guard lock(mutex);
    seq = heartbeat.seq;
  };
  handlers.on_idle = [&] {
    const std::lock_guard lock(mutex);
    idle = true;
    changed.notify_all();
  };
  ASSERT_TRUE(link.server->send(link::Lane::kDelta, kRobot, std::vector<std::byte>(10)));
  ASSERT_TRUE(link.server->send(link::Lane::kHeartbeat, kRobot, std::vector<std::byte>(3)));  // not one
  link::Heartbeat heartbeat;
  heartbeat.seq = 9;
  ASSERT_TRUE(link.server->send(link::Lane::kHeartbeat, kRobot, link::encode_heartbeat(heartbeat)));
  ASSERT_TRUE(link.server->send(link::Lane::kDelta, kRobot, std::vector<std::byte>(20)));
  const Downlink downlink(*link.robot, handlers);
  std::unique_lock lock(mutex);
  ASSERT_TRUE(changed.wait_for(lock, kPatience, [&] { return idle; }));
  EXPECT_EQ(deltas, (std::vector<std::size_t>{10, 20}));
  EXPECT_EQ(seq, 9U);
  EXPECT_EQ(downlink.counters().heartbeats_corrupt, 1U);
}

}  // namespace
}  // namespace edgesplat::uplink
