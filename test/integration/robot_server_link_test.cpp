// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/app/server.hpp"
#include "test/integration/server_link_fixture.hpp"
#include "test/support/child_process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <sstream>

namespace edgesplat {
namespace {

using test::ChildProcess;
using test::RobotEnd;
using namespace std::chrono_literals;

class RobotServerLinkTest : public test::ServerLinkFixture {
 protected:
  std::string metrics() {
    std::ifstream file(folder_.path() / "server" / "metrics.json");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
};

TEST_F(RobotServerLinkTest, BothEndsHoldTheSameMap) {
  SteadyClock clock;
  metrics::Registry registry;
  const config::ServerConfig config;
  const auto transport = *link::open_dds_transport(domain_, {link::Role::kServer, map::RobotId{0}, 0}, clock);
  app::Server server(config, {map::Epoch{1}}, *transport, registry, clock);
  RobotEnd robot(domain_);
  submit_walls(robot, 0, 20);
  ASSERT_TRUE(robot.uplink().drain(60s));
  ASSERT_TRUE(robot.wait_for_delta(map::Epoch{1}, 40, 60s));
  server.finish(10s);
  const auto status = server.status();
  ASSERT_EQ(status.size(), 1U);
  EXPECT_EQ(status[0].seq, 40U);
  EXPECT_EQ(robot.map().map_hash(), status[0].map_hash);
  EXPECT_EQ(robot.map().counters().gaussians, status[0].gaussians);
  EXPECT_GT(status[0].gaussians, 10000U);
  EXPECT_EQ(registry.counter("ingest.corrupt").value(), 0U);
}

TEST_F(RobotServerLinkTest, TheRealServerMapsAndEndsCleanly) {
  ChildProcess server(server_command());
  RobotEnd robot(domain_);
  submit_walls(robot, 0, 10);
  ASSERT_TRUE(robot.wait_for_delta(map::Epoch{1}, 20, 60s));
  EXPECT_TRUE(robot.uplink().drain(60s));
  const auto server_hash = robot.server_hash_at(20, 60s);
  ASSERT_TRUE(server_hash.has_value());
  EXPECT_EQ(robot.map().map_hash(), *server_hash);
  server.signal(SIGTERM);
  EXPECT_EQ(server.wait(20s), 0);
  EXPECT_NE(metrics().find("\"map.keyframes\": 10"), std::string::npos) << metrics();
  EXPECT_NE(metrics().find("\"server.keyframe_to_delta_ms\""), std::string::npos);
  EXPECT_NE(metrics().find("\"link.keyframe.bytes_received\""), std::string::npos);
}

// The robot never waits for the server, and a restarted server (a higher epoch) is heard again.
TEST_F(RobotServerLinkTest, KillingTheServerHoldsNobodyAndARestartIsPickedUp) {
  auto server = std::make_unique<ChildProcess>(server_command());
  RobotEnd robot(domain_);
  submit_walls(robot, 0, 5);
  ASSERT_TRUE(robot.wait_for_delta(map::Epoch{1}, 10, 60s));
  const auto before = robot.map().snapshot();
  server->signal(SIGKILL);
  ASSERT_EQ(server->wait(20s), 128 + SIGKILL);
  nanoseconds slowest{0};
  for (std::uint32_t id = 100; id < 300; ++id) {
    const auto keyframe = std::make_shared<const map::Keyframe>(test::wall_keyframe(id, 3000));
    const HostTime start = robot.clock().now();
    (void)robot.uplink().submit(keyframe);
    slowest = std::max(slowest, robot.clock().now() - start);
  }
  EXPECT_LT(slowest, 20ms);
  EXPECT_EQ(robot.map().position().seq, 10U);
  EXPECT_GE(robot.map().counters().gaussians, before->size());  // what was there stays usable

  server = std::make_unique<ChildProcess>(server_command());
  ASSERT_TRUE(robot.wait_for_delta(map::Epoch{2}, 1, 60s));
  EXPECT_EQ(robot.map().counters().resets, 1U);
  server->signal(SIGINT);
  EXPECT_EQ(server->wait(20s), 0);
}

}  // namespace
}  // namespace edgesplat
