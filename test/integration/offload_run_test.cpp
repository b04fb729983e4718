// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Robot and server as programs of their own, over a link that is made worse on purpose.
#include "test/integration/offload_run_fixture.hpp"

#include <set>
#include <string>
#include <vector>

namespace edgesplat::test {
namespace {

TEST_F(OffloadRun, TheModeFollowsTheLink) {
  const auto robot = run({"--offload", "always", "--set", "offload.switch_interval_s=1.5", "--set",
                          "server.link.impair.shape_at_s=[0, 2.5]", "--set",
                          "server.link.impair.shape_bytes_per_s=[120000, 2000000]"},
                         {});
  ASSERT_EQ(robot.exit_code, 0) << robot.err;
  EXPECT_NE(robot.err.find("made worse on purpose"), std::string::npos);
  std::vector<std::string> modes;
  for (const auto& line : timeline()) {
    const auto mode = line["mode"].get<std::string>();
    if (modes.empty() || modes.back() != mode) modes.push_back(mode);
    if (mode == "FULL") {
      EXPECT_GT(line["bandwidth_bytes_per_s"].get<double>(), 0.8 * 300e3);
    }
  }
  ASSERT_GE(modes.size(), 3U) << robot.err;
  EXPECT_EQ((std::vector<std::string>{modes.begin(), modes.begin() + 3}),
            (std::vector<std::string>{"LOCAL", "LEAN", "FULL"}));
  EXPECT_GT(counters("robot")["spool.sent"].get<int>(), 0);  // what LOCAL kept
  EXPECT_GT(counters("robot")["map.hash_agreed"].get<int>(), 0);
}

TEST_F(OffloadRun, MemoryAloneOffloads) {
  const auto robot = run({"--offload", "auto", "--set", "offload.memory_threshold_bytes=3e7", "--set",
                          "offload.latency_threshold_ms=1000"},
                         {});
  ASSERT_EQ(robot.exit_code, 0) << robot.err;
  EXPECT_NE(robot.err.find("mode=FULL reason=memory"), std::string::npos) << robot.err;
}

TEST_F(OffloadRun, WithoutAServerTheRobotStaysLocal) {
  const auto robot =
      run_program("edgesplat-robot", {"--replay", recording(), "--domain", std::to_string(test_domain()),
                                      "--out", out(), "--set", "server.drain_s=0.1"});
  ASSERT_EQ(robot.exit_code, 0) << robot.err;
  std::set<std::string> modes;
  for (const auto& line : timeline()) modes.insert(line["mode"].get<std::string>());
  EXPECT_EQ(modes, std::set<std::string>{"LOCAL"});
  EXPECT_GT(counters("robot")["uplink.kept_by_mode"].get<int>(), 5);
}

TEST_F(OffloadRun, ABadLinkStillEndsInTheSameMap) {
  std::vector<std::string> bad;
  for (const char* setting : {"loss=0.05", "duplicate=0.05", "reorder=0.1", "flip_bits=0.01", "delay_ms=5"}) {
    bad.insert(bad.end(), {"--set", std::string("link.impair.") + setting});
  }
  std::vector<std::string> robot_bad = bad;
  for (std::size_t i = 1; i < robot_bad.size(); i += 2) robot_bad[i] = "server." + robot_bad[i];
  robot_bad.insert(robot_bad.end(), {"--set", "server.drain_s=20"});
  const auto robot = run(robot_bad, bad);
  ASSERT_EQ(robot.exit_code, 0) << robot.err;
  EXPECT_EQ(robot.err.find("did not answer everything"), std::string::npos) << robot.err;
  const auto up = counters("robot");
  EXPECT_GT(up["link.impaired.lost"].get<int>(), 0);
  EXPECT_GT(up["link.keyframe.chunks_resent"].get<int>() + up["link.spool.chunks_resent"].get<int>(), 0);
  EXPECT_EQ(up["map.hash_disagreed"].get<int>(), 0);
  EXPECT_GT(up["map.hash_agreed"].get<int>(), 0);
  EXPECT_EQ(counters("server")["map.keyframes"].get<int>(), up["uplink.submitted"].get<int>());
}

// The same at 1 Mbit/s each way, where the link is never idle while there is something to map.
TEST_F(OffloadRun, OneMegabitWithEveryFaultKeepsBothSidesInStep) {
  const auto faults = [](const std::string& prefix) {
    std::vector<std::string> settings;
    for (const char* setting : {"loss=0.05", "duplicate=0.03", "reorder=0.1", "flip_bits=0.02", "delay_ms=5",
                                "shape_at_s=[0]", "shape_bytes_per_s=[125000]"})
      settings.insert(settings.end(), {"--set", prefix + "link.impair." + setting});
    return settings;
  };
  std::vector<std::string> on_robot = faults("server."), on_server = faults("");
  on_robot.insert(on_robot.end(), {"--set", "server.drain_s=40"});
  on_server.insert(on_server.end(),
                   {"--set", "optimise.steps_per_view=20"});  // so that the map comes to rest
  const auto robot = run(on_robot, on_server);
  ASSERT_EQ(robot.exit_code, 0) << robot.err;
  EXPECT_EQ(robot.err.find("did not answer everything"), std::string::npos) << robot.err;
  const auto up = counters("robot");
  EXPECT_GT(up["link.impaired.lost"].get<int>(), 0);
  const auto at_server = counters("server");
  int corrupt = 0;
  for (const char* lane : {"heartbeat", "ack", "delta", "keyframe", "spool", "request", "probe"}) {
    const std::string name = "link." + std::string(lane) + ".chunks_corrupt";
    corrupt += up.value(name, 0) + at_server.value(name, 0);
  }
  EXPECT_GT(corrupt, 0);
  EXPECT_GT(up["map.deltas_applied"].get<int>(), 10);
  EXPECT_EQ(up["map.deltas_corrupt"].get<int>(), 0) << "what is corrupt does not get so far";
  EXPECT_EQ(up["map.hash_disagreed"].get<int>(), 0);
  EXPECT_GT(up["map.hash_agreed"].get<int>(), 0);
  EXPECT_EQ(at_server["ingest.corrupt"].get<int>(), 0);
  EXPECT_EQ(at_server["link.delta.messages_dropped"].get<int>(), 0) << "nothing is shed";
}

}  // namespace
}  // namespace edgesplat::test
