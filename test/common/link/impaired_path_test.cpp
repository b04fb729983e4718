// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/impaired_path.hpp"

#include "common/link/in_process_path.hpp"

#include <gtest/gtest.h>

#include <set>

namespace edgesplat::link {
namespace {

using namespace std::chrono_literals;

class ImpairedPathTest : public ::testing::Test {
 protected:
  ImpairedPath& open(const ImpairmentConfig& config) {
    InProcessPaths paths = make_in_process_paths(100000);
    far_ = std::move(paths.server);
    path_ = std::make_unique<ImpairedPath>(config, std::move(paths.robot), clock_);
    return *path_;
  }
  static ChunkHeader header(std::uint32_t train) { return {map::RobotId{1}, 7, train, 0, 1, 1000, 0, 1, 0}; }
  /// Train numbers of what arrived by now, in that order.
  std::vector<std::uint32_t> arrived() {
    path_->pump(clock_.now());
    std::vector<std::uint32_t> trains;
    while (far_->take(Lane::kKeyframe, [&](const ChunkHeader& h, std::span<const std::byte> payload) {
      trains.push_back(h.train);
      changed_ += std::vector<std::byte>(payload.begin(), payload.end()) != payload_ ? 1 : 0;
    })) {
    }
    return trains;
  }
  void write_all(std::uint32_t count) {
    for (std::uint32_t train = 1; train <= count; ++train) {
      ASSERT_EQ(path_->write(Lane::kKeyframe, header(train), payload_), WriteOutcome::kWritten);
    }
  }

  VirtualClock clock_{HostTime(1s)};
  std::vector<std::byte> payload_ = std::vector<std::byte>(1000, std::byte{0x5A});
  std::unique_ptr<ChunkPath> far_;
  std::unique_ptr<ImpairedPath> path_;
  int changed_ = 0;
};

TEST_F(ImpairedPathTest, HoldsTheSenderBackAndKeepsTheRate) {
  ImpairmentConfig config;
  config.shape_at_s = {0.0};
  config.shape_bytes_per_s = {10e3};
  config.burst_bytes = 1;
  config.queue_bytes = 4000;
  open(config);
  std::size_t came = 0;
  std::uint32_t train = 1;
  for (int ms = 0; ms < 10000; ++ms) {
    while (path_->write(Lane::kKeyframe, header(train), payload_) == WriteOutcome::kWritten) ++train;
    clock_.advance_to(clock_.now() + 1ms);
    came += arrived().size();
  }
  EXPECT_NEAR(static_cast<double>(came), 100.0, 1.0);  // 10 kB/s for 10 s
  EXPECT_GT(path_->counters().held_back, 1000U);
  EXPECT_LE(train - 1 - came, 4U);  // the queue's bound
}

TEST_F(ImpairedPathTest, UrgentLanesOvertakeWhatWaits) {
  ImpairmentConfig config;
  config.shape_at_s = {0.0};
  config.shape_bytes_per_s = {1e3};
  open(config);
  write_all(5);
  ASSERT_EQ(path_->write(Lane::kHeartbeat, header(9), payload_), WriteOutcome::kWritten);
  std::uint32_t got = 0;
  EXPECT_TRUE(far_->take(Lane::kHeartbeat, [&](const ChunkHeader& h, auto) { got = h.train; }));
  EXPECT_EQ(got, 9U);
}

TEST_F(ImpairedPathTest, LosesRepeatsAndDamagesWhatItWasToldTo) {
  ImpairmentConfig config;
  config.loss = 0.2;
  config.duplicate = 0.1;
  config.flip_bits = 0.05;
  config.queue_bytes = 1U << 24U;
  open(config);
  write_all(4000);
  const auto trains = arrived();
  const ImpairmentCounters counters = path_->counters();
  EXPECT_NEAR(static_cast<double>(counters.lost), 800.0, 80.0);
  EXPECT_NEAR(static_cast<double>(counters.duplicated), 320.0, 60.0);
  EXPECT_NEAR(static_cast<double>(counters.flipped), 160.0, 40.0);
  EXPECT_EQ(trains.size(), 4000 - counters.lost + counters.duplicated);
  EXPECT_EQ(std::set<std::uint32_t>(trains.begin(), trains.end()).size(), 4000 - counters.lost);
  EXPECT_GE(changed_, static_cast<int>(counters.flipped));
}

TEST_F(ImpairedPathTest, DelaysAndReorders) {
  ImpairmentConfig config;
  config.delay_ms = 50;
  config.reorder = 0.3;
  open(config);
  for (std::uint32_t train = 1; train <= 60; ++train) {
    ASSERT_EQ(path_->write(Lane::kKeyframe, header(train), payload_), WriteOutcome::kWritten);
    clock_.advance_to(clock_.now() + 1ms);
    if (train == 49) {
      EXPECT_TRUE(arrived().empty());
    }
  }
  clock_.advance_to(clock_.now() + 1s);
  const auto trains = arrived();
  EXPECT_EQ(trains.size(), 60U);
  EXPECT_FALSE(std::is_sorted(trains.begin(), trains.end()));
  EXPECT_FALSE(path_->next_event().has_value());
}

TEST_F(ImpairedPathTest, TheSameSeedDoesTheSame) {
  ImpairmentConfig config;
  config.loss = 0.3;
  open(config);
  write_all(200);
  const auto once = arrived();
  open(config);
  write_all(200);
  EXPECT_EQ(arrived(), once);
}

}  // namespace
}  // namespace edgesplat::link
