// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/keyframe_log.hpp"
#include "server/store/map_file.hpp"
#include "test/integration/server_link_fixture.hpp"
#include "test/support/child_process.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <functional>
#include <thread>

namespace edgesplat {
namespace {

using test::ChildProcess;
using test::RobotEnd;
using namespace std::chrono_literals;

/// A server that is killed and started again in the same folder.
class ServerRestartTest : public test::ServerLinkFixture {
 protected:
  std::unique_ptr<ChildProcess> start_server() {
    return std::make_unique<ChildProcess>(
        server_command({"--set", "store.save_period_s=0.1", "--set", "optimise.enabled=false"}));
  }
  /// As the robot's program does: says who it is and what it has, until `done`.
  static bool speak_until(RobotEnd& robot, const std::function<bool()>& done) {
    for (int i = 0; i < 300 && !done(); ++i) {
      link::Heartbeat heartbeat;
      heartbeat.epoch = robot.map().position().epoch;
      heartbeat.seq = robot.map().position().seq;
      (void)robot.transport().send(link::Lane::kHeartbeat, RobotEnd::kRobot,
                                   link::encode_heartbeat(heartbeat));
      std::this_thread::sleep_for(100ms);
    }
    return done();
  }
  [[nodiscard]] std::vector<std::filesystem::path> map_files() const {
    std::vector<std::filesystem::path> files;
    std::error_code none;
    for (const auto& file : std::filesystem::directory_iterator(folder_.path() / "server" / "store", none))
      if (file.path().extension() == ".map") files.push_back(file.path());
    return files;
  }
};

TEST_F(ServerRestartTest, AKilledServerGoesOnWithTheMapOfARobotThatStillRuns) {
  auto server = start_server();
  RobotEnd robot(domain_);
  submit_walls(robot, 0, 5);
  ASSERT_TRUE(robot.wait_for_delta(map::Epoch{1}, 10, 60s));
  const auto before = robot.map().counters().gaussians;
  const auto hash = robot.map().map_hash();
  ASSERT_TRUE(speak_until(robot, [&] {
    const auto files = map_files();
    if (files.size() != 1) return false;
    const auto saved = store::load_map(files[0]);
    return saved && saved->map.gaussians.size() == before;
  }));
  server->signal(SIGKILL);
  ASSERT_EQ(server->wait(20s), 128 + SIGKILL);

  const HostTime killed = robot.clock().now();
  server = start_server();
  ASSERT_TRUE(speak_until(robot,
                          [&] {
                            return robot.map().position().epoch == map::Epoch{2} &&
                                   robot.map().counters().gaussians == before;
                          }))
      << robot.map().counters().gaussians << " of " << before;
  RecordProperty("back_after_ms", static_cast<int>(to_seconds(robot.clock().now() - killed) * 1e3));
  EXPECT_EQ(robot.map().map_hash(), hash);  // the same Gaussians by name and value

  // What it covers is not seeded again; a place of its own is.
  submit_walls(robot, 3, 1);
  submit_walls(robot, 20, 1);
  ASSERT_TRUE(speak_until(robot, [&] { return robot.map().counters().gaussians > before + before / 10; }));
  EXPECT_LT(robot.map().counters().gaussians, before + before / 4);
  server->signal(SIGTERM);
  EXPECT_EQ(server->wait(20s), 0);
  EXPECT_EQ(map_files().size(), 1U);
}

TEST_F(ServerRestartTest, WhatCameAfterTheLastSaveIsMappedAgainFromTheKeyframeLog) {
  const auto start_unsaving = [&] {
    return std::make_unique<ChildProcess>(
        server_command({"--set", "store.save_period_s=3600", "--set", "optimise.enabled=false"}));
  };
  auto server = start_unsaving();
  RobotEnd robot(domain_);
  submit_walls(robot, 0, 4);
  ASSERT_TRUE(robot.wait_for_delta(map::Epoch{1}, 8, 60s));
  const auto before = robot.map().counters().gaussians;
  const auto store_folder = folder_.path() / "server" / "store";
  ASSERT_TRUE(speak_until(robot, [&] {
    const auto logged = store::read_newest_keyframes(store_folder);
    return logged && logged->size() == 4;
  }));
  ASSERT_TRUE(map_files().empty());
  server->signal(SIGKILL);
  ASSERT_EQ(server->wait(20s), 128 + SIGKILL);

  server = start_unsaving();
  EXPECT_TRUE(speak_until(robot,
                          [&] {
                            return robot.map().position().epoch == map::Epoch{2} &&
                                   robot.map().counters().gaussians == before;
                          }))
      << robot.map().counters().gaussians << " of " << before;
  server->signal(SIGTERM);
  EXPECT_EQ(server->wait(20s), 0);

  // The end saved it: a third server has nothing to map again.
  server = start_unsaving();
  EXPECT_TRUE(speak_until(robot, [&] {
    return robot.map().position().epoch == map::Epoch{3} && robot.map().counters().gaussians == before;
  })) << robot.map().counters().gaussians;
  server->signal(SIGTERM);
  EXPECT_EQ(server->wait(20s), 0);
}

TEST_F(ServerRestartTest, ARobotThatBeganAnewGetsAMapOfItsOwnAndTheOldFileStays) {
  auto server = start_server();
  {
    RobotEnd robot(domain_);
    submit_walls(robot, 0, 1);
    ASSERT_TRUE(robot.wait_for_delta(map::Epoch{1}, 2, 60s));
  }
  server->signal(SIGTERM);
  ASSERT_EQ(server->wait(20s), 0);
  ASSERT_EQ(map_files().size(), 1U);
  server = start_server();
  RobotEnd robot(domain_);
  submit_walls(robot, 7, 1);
  ASSERT_TRUE(robot.wait_for_delta(map::Epoch{2}, 1, 60s));
  const auto snapshot = robot.map().snapshot();
  for (std::size_t row = 0; row < snapshot->size(); ++row)
    ASSERT_GT(snapshot->means_m[3 * row + 1], 30.0F);  // nothing of the first wall
  server->signal(SIGTERM);
  EXPECT_EQ(server->wait(20s), 0);
  EXPECT_EQ(map_files().size(), 2U);
}

TEST_F(ServerRestartTest, ADamagedMapFileNeverStopsTheServer) {
  auto server = start_server();
  RobotEnd robot(domain_);
  submit_walls(robot, 0, 1);
  ASSERT_TRUE(robot.wait_for_delta(map::Epoch{1}, 2, 60s));
  server->signal(SIGTERM);
  ASSERT_EQ(server->wait(20s), 0);
  ASSERT_EQ(map_files().size(), 1U);
  std::filesystem::resize_file(map_files()[0], 20);
  server = start_server();
  submit_walls(robot, 1, 1);
  ASSERT_TRUE(robot.wait_for_delta(map::Epoch{2}, 1, 60s));
  server->signal(SIGTERM);
  EXPECT_EQ(server->wait(20s), 0);
}

}  // namespace
}  // namespace edgesplat
