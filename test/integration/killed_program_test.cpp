// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The server's program, killed at random moments and started again while its robot goes on, over DDS.
#include "test/integration/server_link_fixture.hpp"
#include "test/support/child_process.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <thread>

namespace edgesplat {
namespace {

using test::ChildProcess;
using test::RobotEnd;
using namespace std::chrono_literals;

constexpr int kRounds = 20;

class KilledProgram : public test::ServerLinkFixture {
 protected:
  void start_server() {
    server_ = std::make_unique<ChildProcess>(
        server_command({"--set", "store.save_period_s=0.2", "--set", "optimise.enabled=false"}));
  }
  /// A new wall every 0.1 s, and the heartbeats of the robot's program.
  void drive(RobotEnd& robot, double seconds) {
    for (const HostTime end = robot.clock().now() + from_seconds(seconds); robot.clock().now() < end;) {
      submit_walls(robot, walls_++, 1);
      speak(robot);
    }
  }
  static void speak(RobotEnd& robot) {
    link::Heartbeat heartbeat;
    heartbeat.epoch = robot.map().position().epoch;
    heartbeat.seq = robot.map().position().seq;
    (void)robot.transport().send(link::Lane::kHeartbeat, RobotEnd::kRobot, link::encode_heartbeat(heartbeat));
    std::this_thread::sleep_for(100ms);
  }
  /// Both sides are at the same delta of `epoch` with the same hash, and the server has nothing under way.
  static bool agree(RobotEnd& robot, map::Epoch epoch) {
    for (int i = 0; i < 300; ++i) {
      const auto here = robot.map().position();
      const auto server = robot.server_heartbeat();
      if (here.epoch == epoch && server.epoch == epoch && server.seq == here.seq &&
          server.queued_messages == 0 && robot.map().map_hash() == server.map_hash)
        return true;
      speak(robot);
    }
    return false;
  }

  std::unique_ptr<ChildProcess> server_;
  std::uint32_t walls_ = 0;
};

TEST_F(KilledProgram, IsReplacedTwentyTimesAndBothSidesAgreeEachTime) {
  test::Random random(7);
  RobotEnd robot(domain_);
  start_server();
  drive(robot, 1.0);
  ASSERT_TRUE(agree(robot, map::Epoch{1}));
  std::size_t most = 0;
  for (int round = 0; round < kRounds; ++round) {
    drive(robot, random.uniform(0.0, 1.0));
    server_->signal(SIGKILL);
    ASSERT_EQ(server_->wait(20s), 128 + SIGKILL);
    const std::size_t held = robot.map().counters().gaussians;
    drive(robot, random.uniform(0.0, 0.5));
    EXPECT_GE(robot.map().counters().gaussians, held) << "what the robot has, it keeps";
    start_server();
    const map::Epoch epoch{static_cast<std::uint32_t>(round + 2)};
    ASSERT_TRUE(agree(robot, epoch)) << "round " << round;
    most = std::max(most, robot.map().counters().gaussians);
  }
  const auto counters = robot.map().counters();
  EXPECT_EQ(counters.hash_disagreed, 0U);
  EXPECT_GE(counters.hash_agreed, static_cast<std::uint64_t>(kRounds));
  EXPECT_EQ(counters.corrupt, 0U);
  EXPECT_EQ(counters.foreign, 0U);
  EXPECT_GE(counters.resets, static_cast<std::uint64_t>(kRounds));
  EXPECT_GT(counters.gaussians, most / 2) << "the map is not lost with the server";
  server_->signal(SIGTERM);
  EXPECT_EQ(server_->wait(20s), 0);
}

}  // namespace
}  // namespace edgesplat
