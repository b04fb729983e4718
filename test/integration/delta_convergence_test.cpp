// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/map/resident_map.hpp"
#include "server/stream/delta_stream.hpp"
#include "server/stream/map_uuid.hpp"
#include "test/integration/changing_map.hpp"
#include "test/integration/delta_faults.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

namespace edgesplat::map {
namespace {

constexpr double kStep_s = 0.01;
constexpr test::Faults kBad{0.05, 0.03, 0.01, 0.01, 0.08};

/// A server whose map goes on changing, a robot, and a bad network between them, in virtual time.
class Bench {
 public:
  explicit Bench(std::uint64_t seed, std::size_t budget_bytes = std::size_t{512} << 20U)
      : random_(seed),
        map_(seed + 3),
        down_(kBad, seed + 1),
        up_(kBad, seed + 2),
        robot_(robot_config(budget_bytes)) {
    start_server();
  }

  /// The server's process is new: another epoch, the same Gaussians.
  void start_server() {
    ++epoch_;
    stream::DeltaStreamConfig config;
    config.robot.value = 1;
    config.map = name_;
    config.epoch.value = epoch_;
    config.max_rows = 300;
    config.ring_deltas = 200;
    config.window_bytes = 20000;
    stream_ = std::make_unique<stream::DeltaStream>(config);
    hash_at_.clear();
    publish(map_.all_rows());
  }
  void set_faults(const test::Faults& faults) {
    down_.set_faults(faults);
    up_.set_faults(faults);
  }

  void run(double seconds, bool changing) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds / kStep_s)); ++i) step(changing);
  }
  /// Seconds until both sides are at the same delta with the same hash and, where `whole`, nothing waits;
  /// nothing where that takes over 10 s.
  std::optional<double> settle(bool whole = true) {
    for (int i = 0; i < 1000; ++i) {
      const auto server = stream_->position();
      const auto robot = robot_.position();
      if (robot.epoch.value == epoch_ && robot.seq == server.seq && robot_.map_hash() == server.map_hash &&
          stream_->counters().waiting == 0 && !(whole && stream_->counters().waiting_chunks > 0))
        return i * kStep_s;
      step(false);
    }
    return std::nullopt;
  }

  void move_robot(const Eigen::Vector3f& p_in_map_m) { robot_.robot_at(p_in_map_m); }
  [[nodiscard]] const ResidentMap& robot() const { return robot_; }
  [[nodiscard]] const stream::DeltaStream& server() const { return *stream_; }
  [[nodiscard]] const gaussian::GaussianCloud& cloud() const { return map_.cloud(); }
  [[nodiscard]] std::size_t flipped() const { return down_.flipped(); }
  /// Robot's hashes that could be compared with the server's at the same delta, and agreed.
  [[nodiscard]] std::size_t checked() const { return checked_; }

 private:
  static ResidentMapConfig robot_config(std::size_t budget_bytes) {
    ResidentMapConfig config;
    config.budget_bytes = budget_bytes;
    return config;
  }
  void publish(const std::vector<std::uint32_t>& changed) {
    for (auto& delta : stream_->publish(map_.cloud(), changed, map_.take_removed(), 20000))
      down_.send(std::move(delta), now_);
    hash_at_[stream_->position().seq] = stream_->position().map_hash;
  }

  void change_map() {
    map_.change();
    const auto correction = map_.correction();
    if (!correction) return;
    for (auto& delta : stream_->repose(std::span(&*correction, 1))) down_.send(std::move(delta), now_);
  }

  void step(bool changing) {
    ++steps_;
    now_ += from_seconds(kStep_s);
    if (steps_ % 10 == 0) {
      if (changing) change_map();
      publish(changing ? map_.all_rows() : std::vector<std::uint32_t>{});
    }
    for (const auto& bytes : up_.arrived(now_)) {
      const auto request = decode_map_request(bytes);
      if (!request) continue;
      for (auto& delta : stream_->answer(*request, now_)) down_.send(std::move(delta), now_);
    }
    for (const auto& bytes : down_.arrived(now_)) {
      (void)robot_.apply(bytes, now_);
      check_robot();
    }
    if (steps_ % 20 == 0 && random_.uniform() >= 0.05) {
      const auto at = stream_->position();
      robot_.server_at({Epoch{epoch_}, at.seq}, at.map_hash, true, now_);
    }
    for (const auto& request : robot_.requests(now_)) up_.send(encode_map_request(request), now_);
  }

  /// At a delta whose hash the server noted, the robot's must be the same, whatever happened before.
  void check_robot() {
    const auto counters = robot_.counters();
    ASSERT_LE(counters.held_now, 64U);
    const auto at = robot_.position();
    const auto noted = hash_at_.find(at.seq);
    if (at.epoch.value != epoch_ || noted == hash_at_.end() || counters.evicted_chunks > 0) return;
    ASSERT_EQ(robot_.map_hash(), noted->second) << "at delta " << at.seq;
    ++checked_;
  }

  test::Random random_;
  test::ChangingMap map_;
  HostTime now_{};
  int steps_ = 0;
  std::uint32_t epoch_ = 0;
  MapUuid name_ = stream::make_map_uuid();
  std::unique_ptr<stream::DeltaStream> stream_;
  test::FaultyWay down_;
  test::FaultyWay up_;
  ResidentMap robot_;
  std::map<std::uint64_t, std::uint64_t> hash_at_;
  std::size_t checked_ = 0;
};

class DeltaConvergence : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(DeltaConvergence, UnderLossDuplicatesReorderingAndFlippedBits) {
  Bench bench(GetParam());
  bench.run(20.0, true);
  const auto settled_s = bench.settle();
  ASSERT_TRUE(settled_s.has_value());
  EXPECT_LT(*settled_s, 5.0);
  const auto counters = bench.robot().counters();
  EXPECT_EQ(counters.gaussians, bench.cloud().size());
  RecordProperty("settled_s", std::to_string(*settled_s));
  RecordProperty("resends_asked", std::to_string(counters.resends_asked));
  RecordProperty("snapshots_asked", std::to_string(counters.snapshots_asked));
  RecordProperty("applied", std::to_string(counters.applied));
  EXPECT_GT(bench.flipped(), 0U);
  EXPECT_GT(counters.corrupt, 0U);
  EXPECT_LE(counters.corrupt, bench.flipped());
  EXPECT_GT(counters.duplicates, 0U);
  EXPECT_GT(counters.resends_asked, 0U);
  EXPECT_EQ(counters.hash_disagreed, 0U);
  EXPECT_GT(bench.checked(), 100U);
  EXPECT_EQ(bench.server().counters().refused, 0U);
}

TEST_P(DeltaConvergence, AfterTheServerStartedAnew) {
  Bench bench(GetParam());
  for (int round = 0; round < 4; ++round) {
    bench.run(3.0, true);
    bench.start_server();
  }
  bench.run(2.0, true);
  ASSERT_TRUE(bench.settle().has_value());
  EXPECT_EQ(bench.robot().position().epoch.value, 5U);
  EXPECT_EQ(bench.robot().counters().gaussians, bench.cloud().size());
}

TEST_P(DeltaConvergence, AfterFiveSecondsOfSilence) {
  Bench bench(GetParam());
  bench.run(5.0, true);
  bench.set_faults({1.0, 0, 0, 0.01, 0.02});
  bench.run(5.0, true);
  bench.set_faults(kBad);
  const auto settled_s = bench.settle();
  ASSERT_TRUE(settled_s.has_value());
  EXPECT_LT(*settled_s, 6.0);
  EXPECT_EQ(bench.robot().counters().gaussians, bench.cloud().size());
}

TEST_P(DeltaConvergence, WithAMemoryTooSmallForTheMap) {
  constexpr std::size_t kBudget_bytes = 600000;
  Bench bench(GetParam(), kBudget_bytes);
  for (int second = 0; second < 30; ++second) {
    bench.move_robot({20.0F * static_cast<float>(std::sin(0.3 * second)), 0.0F, 0.0F});
    bench.run(1.0, true);
    EXPECT_EQ(bench.robot().counters().over_budget_bytes, 0U);
  }
  ASSERT_TRUE(bench.settle(false).has_value());
  const auto counters = bench.robot().counters();
  EXPECT_LT(counters.gaussians, bench.cloud().size());
  EXPECT_GT(counters.gaussians, bench.cloud().size() / 10);
  EXPECT_GT(counters.absent_chunks + bench.server().counters().waiting_chunks, 0U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, DeltaConvergence, ::testing::Range(std::uint64_t{1}, std::uint64_t{6}));

}  // namespace
}  // namespace edgesplat::map
