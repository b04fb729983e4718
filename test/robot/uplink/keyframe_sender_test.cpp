// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The sender on the real link code in virtual time: what really goes up when the link narrows.
#include "robot/uplink/keyframe_sender.hpp"

#include "common/io/image_file.hpp"
#include "test/common/link/simulated_link.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/message_bytes.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace edgesplat::uplink {
namespace {

using link::Lane;
using link::OffloadMode;
using link::SimulatedLink;

constexpr map::RobotId kRobot = SimulatedLink::kRobot;
constexpr double kNarrow_bytes_per_s = 120e3;
constexpr double kNarrow_at_s = 8.0;

SenderConfig budgets() {
  SenderConfig config;
  config.router.full_bytes_per_s = 290e3;
  config.router.lean_bytes_per_s = 57e3;
  config.full_keyframe_bytes = 120'000;
  config.lean_keyframe_bytes = 40'000;
  return config;
}

link::LinkEndOptions narrowing() {
  link::LinkEndOptions options;
  options.impair.shape_at_s = {0.0, kNarrow_at_s};
  options.impair.shape_bytes_per_s = {1e6, kNarrow_bytes_per_s};
  options.impair.delay_ms = 5;
  options.impair.loss = 0.02;
  return options;
}

/// A camera's view with structure at all scales: about 90 KB with its points.
map::Keyframe keyframe(std::uint32_t id) {
  map::Keyframe keyframe = test::random_keyframe(id, 4000, id);
  test::Random random(id);
  sensor::ImageRgb8 picture(320, 256);
  for (auto& value : picture.values) value = static_cast<std::uint8_t>(random.below(120));
  auto image = std::make_shared<map::EncodedImage>();
  image->format = map::EncodedImage::Format::kJpeg;
  image->width_px = picture.width_px;
  image->height_px = picture.height_px;
  image->bytes = *io::encode_jpeg(picture, 92);
  keyframe.image = std::move(image);
  return keyframe;
}

/// A robot that sends keyframes up and acknowledges deltas that come down, at the pace of the demo.
class Drive {
 public:
  explicit Drive(SimulatedLink& link) : link_(link), sender_(budgets(), link.robot(), link.clock) {}

  void run(double seconds) {
    link_.run(seconds, [this](double) { step(); });
  }
  void set_mode(OffloadMode mode) { sender_.set_mode(mode); }
  [[nodiscard]] const KeyframeSender& sender() const { return sender_; }
  [[nodiscard]] std::uint64_t bytes_up() const {
    std::uint64_t bytes = 0;
    for (const auto& lane : link_.robot().counters()) bytes += lane.bytes_sent;
    return bytes;
  }

 private:
  [[nodiscard]] bool due(HostTime& next, double period_s) const {
    if (link_.clock.now() < next) return false;
    next = link_.clock.now() + from_seconds(period_s);
    return true;
  }
  void step() {
    if (due(next_keyframe_, 0.3)) {
      sender_.send(keyframe(++keyframes_));
    } else if (due(next_spooled_, 0.05)) {
      sender_.send_spooled(false);
    }
    if (due(next_heartbeat_, 0.2))
      (void)link_.robot().send(Lane::kHeartbeat, kRobot, test::message_bytes(80));
    if (due(next_delta_, 0.05)) (void)link_.server().send(Lane::kDelta, kRobot, test::message_bytes(10'000));
    while (link_.robot().receive(nanoseconds(0))) {
    }
    while (link_.server().receive(nanoseconds(0))) {
    }
  }

  SimulatedLink& link_;
  KeyframeSender sender_;
  std::uint32_t keyframes_ = 0;
  HostTime next_keyframe_{}, next_spooled_{}, next_heartbeat_{}, next_delta_{};
};

TEST(KeyframeSender, KeepsLeansBudgetOverAllLanesFromTheSwitchOn) {
  SimulatedLink link(narrowing(), {});
  Drive drive(link);
  drive.run(kNarrow_at_s);
  EXPECT_LT(static_cast<double>(drive.bytes_up()) / kNarrow_at_s, 300e3);
  EXPECT_GT(static_cast<double>(drive.bytes_up()) / kNarrow_at_s, 200e3);
  drive.run(1.0);  // until the policy has seen it
  const auto unsent = link.robot().counters()[link::index_of(Lane::kKeyframe)].unsent_bytes;
  EXPECT_GT(unsent, 20'000U) << "FULL leaves something behind";
  drive.set_mode(OffloadMode::kLean);
  const std::uint64_t before = drive.bytes_up();
  double worst_bytes_per_s = 0.0;
  for (double t_s = 0.25; t_s <= 30.0; t_s += 0.25) {
    drive.run(0.25);
    const double mean_bytes_per_s = static_cast<double>(drive.bytes_up() - before) / t_s;
    if (t_s >= 5.0) worst_bytes_per_s = std::max(worst_bytes_per_s, mean_bytes_per_s);
  }
  EXPECT_LE(worst_bytes_per_s, 60e3);
  EXPECT_GE(static_cast<double>(drive.bytes_up() - before) / 30.0, 45e3) << "the budget is there to be used";
  RecordProperty("worst_bytes_per_s", std::to_string(worst_bytes_per_s));
  RecordProperty("mean_bytes_per_s", std::to_string(static_cast<double>(drive.bytes_up() - before) / 30.0));
  RecordProperty("unsent_bytes_at_the_switch", std::to_string(unsent));
}

TEST(KeyframeSender, WhatTheLinkHasNotBegunIsSpooledWhenTheModeGoesDownAndSentInTheEnd) {
  SimulatedLink link(narrowing(), {});
  KeyframeSender sender(SenderConfig{}, link.robot(), link.clock);
  for (std::uint32_t id = 1; id <= 10; ++id) sender.send(keyframe(id));
  link.run(0.05);
  sender.set_mode(OffloadMode::kLocal);
  const auto withdrawn = sender.counters().withdrawn;
  EXPECT_GE(withdrawn, 8U);
  EXPECT_EQ(sender.counters().spool.items, withdrawn);
  EXPECT_EQ(link.robot().counters()[link::index_of(Lane::kKeyframe)].messages_withdrawn, withdrawn);
  std::size_t came = 0;
  const auto take = [&](double) {
    sender.send_spooled(false);
    while (link.server().receive(nanoseconds(0))) ++came;
  };
  link.run(1.0, take);
  EXPECT_EQ(came, 10 - withdrawn) << "LOCAL sends nothing";
  sender.set_mode(OffloadMode::kFull);
  link.run(20.0, take);
  EXPECT_EQ(came, 10U);
  EXPECT_TRUE(sender.spool_empty());
}

}  // namespace
}  // namespace edgesplat::uplink
