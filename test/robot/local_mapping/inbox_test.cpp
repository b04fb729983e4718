// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/local_mapping/inbox.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace edgesplat::local_mapping {
namespace {

std::shared_ptr<const map::Keyframe> keyframe(std::uint32_t id) {
  auto made = std::make_shared<map::Keyframe>();
  made->id.value = id;
  return made;
}

Inbox::Round take_now(Inbox& inbox, bool with_keyframe = true) {
  return inbox.take({}, nanoseconds(0), with_keyframe);
}

TEST(LocalInbox, KeepsTheNewestKeyframesAndCountsTheOthers) {
  Inbox inbox(3);
  inbox.set_work(true, false);
  for (std::uint32_t id = 0; id < 10; ++id) inbox.submit(keyframe(id));
  EXPECT_EQ(inbox.dropped(), 7U);
  for (std::uint32_t id = 7; id < 10; ++id) EXPECT_EQ(take_now(inbox).keyframe->id.value, id);
  EXPECT_EQ(take_now(inbox).keyframe, nullptr);
}

TEST(LocalInbox, TakesKeyframesInLocalAlone) {
  Inbox inbox(3);
  inbox.submit(keyframe(1));
  EXPECT_EQ(take_now(inbox).keyframe, nullptr);
  inbox.set_work(true, false);
  inbox.submit(keyframe(2));
  inbox.set_work(false, false);
  EXPECT_EQ(take_now(inbox).keyframe, nullptr);
  EXPECT_EQ(inbox.dropped(), 0U);
}

TEST(LocalInbox, OrdersAreTakenOnce) {
  Inbox inbox(3);
  inbox.set_work(true, true);
  inbox.set_work(true, false);
  inbox.retire({1, 2});
  inbox.retire({3});
  inbox.set_resident(std::make_shared<const gaussian::GaussianCloud>());
  inbox.submit(keyframe(1));
  const auto round = take_now(inbox, false);
  EXPECT_EQ(round.map_here, std::optional(true));
  EXPECT_TRUE(round.prune);
  EXPECT_EQ(round.mapped, (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_TRUE(round.resident_in_odom.has_value());
  EXPECT_EQ(round.keyframe, nullptr);
  const auto next = take_now(inbox, true);
  EXPECT_FALSE(next.map_here || next.prune || next.resident_in_odom || !next.mapped.empty());
  EXPECT_NE(next.keyframe, nullptr);
}

TEST(LocalInbox, AnOrderWakesTheTaker) {
  Inbox inbox(3);
  std::jthread taker([&](const std::stop_token& stop) {
    const auto round = inbox.take(stop, std::nullopt, true);
    EXPECT_EQ(round.map_here, std::optional(true));
  });
  inbox.set_work(true, false);
}

TEST(LocalInbox, SettlesWhenAllIsDone) {
  Inbox inbox(3);
  EXPECT_FALSE(inbox.settle(std::chrono::milliseconds(1)));
  inbox.set_work(true, false);
  inbox.submit(keyframe(1));
  inbox.done();
  EXPECT_TRUE(inbox.settling());  // a keyframe is left
  EXPECT_NE(take_now(inbox, false).keyframe, nullptr);
  inbox.done();
  EXPECT_FALSE(inbox.settling());
}

}  // namespace
}  // namespace edgesplat::local_mapping
