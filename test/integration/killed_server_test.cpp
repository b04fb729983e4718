// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// A server that is killed at random moments, twenty times, while its robot drives on: in virtual time, with
// the real link, ingest, mapping, delta stream and map files.
#include "common/map/keyframe_codec.hpp"
#include "test/common/link/restartable_link.hpp"
#include "test/integration/virtual_robot.hpp"
#include "test/integration/virtual_server.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/random.hpp"
#include "test/support/temp_dir.hpp"

#include <optional>
#include <string>

namespace edgesplat {
namespace {

constexpr int kRounds = 20;

link::LinkEndOptions lossy_end(std::uint64_t seed) {
  link::LinkEndOptions options;
  options.impair.delay_ms = 5;
  options.impair.loss = 0.02;
  options.impair.duplicate = 0.02;
  options.impair.reorder = 0.05;
  options.impair.flip_bits = 0.01;
  options.impair.seed = seed;
  return options;
}

config::ServerConfig server_config() {
  config::ServerConfig config;
  config.store.save_period_s = 0.7;
  return config;
}

class KilledServer : public ::testing::Test {
 protected:
  void start_server() {
    link_.start_server();
    server_.emplace(server_config(), folder_.path(), *link_.server(), link_.clock);
  }
  void kill_server() {
    if (random_.uniform() < 0.3) server_->leave_half_a_save(random_.below(20000));
    server_.reset();
    link_.kill_server();
  }
  /// The robot sees a new wall every 0.2 s.
  void drive(double seconds) {
    link_.run(seconds, [this] {
      if (link_.clock.now() >= next_wall_) {
        next_wall_ = link_.clock.now() + std::chrono::milliseconds(200);
        auto keyframe = test::wall_keyframe(walls_, 100);
        keyframe.odom_from_body.translation_m.y() = 5.0 * walls_++;
        robot_.send(*map::encode_keyframe(keyframe));
      }
      step();
    });
  }
  void step() {
    robot_.step();
    if (server_) server_->step();
  }
  [[nodiscard]] bool agreed() {
    const auto server = server_->status();
    const auto robot = robot_.map().position();
    return server && robot.epoch == server->epoch && robot.seq == server->seq &&
           robot_.map().map_hash() == server->map_hash &&
           robot_.map().counters().gaussians == server_->gaussians();
  }
  /// Seconds until both sides agree, with nothing new to map and all that was sent mapped.
  std::optional<double> settle() {
    for (double t_s = 0.0; t_s < 20.0; t_s += 0.1) {
      const auto up = link_.robot().counters()[link::index_of(link::Lane::kKeyframe)];
      if (up.queued_messages + up.flying_messages == 0 && agreed()) return t_s;
      link_.run(0.1, [this] { step(); });
    }
    return std::nullopt;
  }
  /// Whatever happened before, the robot's hash after a delta is what the server noted for it.
  void check(const map::MapPosition& at, std::uint64_t hash) {
    if (!server_ || at.epoch != server_->epoch()) return;
    const auto noted = server_->hash_at(at.seq);
    if (!noted) return;
    EXPECT_EQ(hash, *noted) << "at delta " << at.seq;
    ++checked_;
  }

  test::TempDir folder_;
  test::Random random_{1};
  test::RestartableLink link_{lossy_end(1), lossy_end(2)};
  std::optional<test::VirtualServer> server_;
  test::VirtualRobot robot_{link_.robot(), link_.clock,
                            [this](const map::MapPosition& at, std::uint64_t hash) { check(at, hash); }};
  HostTime next_wall_{};
  std::uint32_t walls_ = 0;
  std::size_t checked_ = 0;
};

TEST_F(KilledServer, IsReplacedTwentyTimesAndBothSidesAgreeEachTime) {
  start_server();
  drive(2.0);
  double longest_s = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    drive(random_.uniform(0.05, 2.5));
    const std::size_t before = robot_.map().counters().gaussians;
    kill_server();
    drive(random_.uniform(0.0, 2.0));
    EXPECT_EQ(robot_.map().counters().gaussians, before) << "what the robot has, it keeps";
    start_server();
    drive(random_.uniform(0.0, 0.5));
    const auto settled_s = settle();
    ASSERT_TRUE(settled_s.has_value()) << "round " << round;
    EXPECT_EQ(robot_.map().position().epoch.value, static_cast<std::uint32_t>(round + 2));
    longest_s = std::max(longest_s, *settled_s);
  }
  const auto counters = robot_.map().counters();
  EXPECT_EQ(counters.hash_disagreed, 0U);
  EXPECT_EQ(counters.corrupt, 0U);
  EXPECT_GE(counters.resets, static_cast<std::uint64_t>(kRounds));
  EXPECT_GT(checked_, 100U);
  // What was mapped since the last save is lost with the server, nothing else.
  EXPECT_GT(counters.gaussians, 100U * walls_ / 2);
  RecordProperty("longest_settled_s", std::to_string(longest_s));
  RecordProperty("walls", std::to_string(walls_));
  RecordProperty("gaussians", std::to_string(counters.gaussians));
  RecordProperty("deltas_checked", std::to_string(checked_));
}

}  // namespace
}  // namespace edgesplat
