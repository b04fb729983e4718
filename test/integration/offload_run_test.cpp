// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Robot and server as programs of their own, over a link that is made worse on purpose.
#include "test/integration/program.hpp"
#include "test/support/test_domain.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <set>
#include <sstream>

namespace edgesplat::test {
namespace {

class OffloadRun : public testing::Test {
 protected:
  [[nodiscard]] std::string out() const { return folder_.path() / "run"; }
  /// Runs both programs over a recording in real time; the robot's result.
  ProgramResult run(const std::vector<std::string>& robot_more, const std::vector<std::string>& server_more) {
    const std::string recording = shared_recording(
        "corridor6", {"--world", "corridor", "--seconds", "6", "--pedestrians", "2", "--seed", "3"});
    const std::string domain = std::to_string(test_domain());
    std::vector<std::string> server_arguments = {"--domain", domain, "--out", out()};
    server_arguments.insert(server_arguments.end(), server_more.begin(), server_more.end());
    Program server("edgesplat-server", server_arguments);
    EXPECT_TRUE(server.wait_for_stderr("ready", std::chrono::seconds(20)));
    std::vector<std::string> arguments = {"--replay", recording, "--domain", domain, "--out", out()};
    arguments.insert(arguments.end(), robot_more.begin(), robot_more.end());
    Program robot("edgesplat-robot", arguments);
    ProgramResult result = robot.wait(std::chrono::seconds(120));
    server.signal(SIGTERM);
    EXPECT_EQ(server.wait(std::chrono::seconds(30)).exit_code, 0);
    return result;
  }
  [[nodiscard]] std::vector<nlohmann::json> timeline() const {
    std::vector<nlohmann::json> lines;
    std::istringstream text(text_of(out() + "/robot/modes.jsonl"));
    for (std::string line; std::getline(text, line);) lines.push_back(nlohmann::json::parse(line));
    return lines;
  }
  [[nodiscard]] nlohmann::json counters(const std::string& program) const {
    return nlohmann::json::parse(text_of(out() + "/" + program + "/metrics.json"))["counters"];
  }

 private:
  TempDir folder_;
};

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
  const auto robot = run({"--offload", "auto", "--set", "offload.memory_threshold_bytes=3e7"}, {});
  ASSERT_EQ(robot.exit_code, 0) << robot.err;
  EXPECT_NE(robot.err.find("mode=FULL reason=memory"), std::string::npos) << robot.err;
}

TEST_F(OffloadRun, WithoutAServerTheRobotStaysLocal) {
  const std::string recording = shared_recording(
      "corridor6", {"--world", "corridor", "--seconds", "6", "--pedestrians", "2", "--seed", "3"});
  const auto robot =
      run_program("edgesplat-robot", {"--replay", recording, "--domain", std::to_string(test_domain()),
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

}  // namespace
}  // namespace edgesplat::test
