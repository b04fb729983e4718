// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "test/integration/program.hpp"
#include "test/support/test_domain.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <sstream>
#include <string>
#include <vector>

namespace edgesplat::test {

/// Robot and server as programs of their own in a run folder of the test's.
class OffloadRun : public testing::Test {
 protected:
  /// Six seconds in the corridor, two people.
  static std::string recording() {
    return shared_recording("corridor6",
                            {"--world", "corridor", "--seconds", "6", "--pedestrians", "2", "--seed", "3"});
  }
  [[nodiscard]] std::string out() const { return folder_.path() / "run"; }
  /// Runs both programs over a recording in real time; the robot's result.
  ProgramResult run(const std::vector<std::string>& robot_more, const std::vector<std::string>& server_more) {
    const std::string domain = std::to_string(test_domain());
    std::vector<std::string> server_arguments = {"--domain", domain, "--out", out()};
    server_arguments.insert(server_arguments.end(), server_more.begin(), server_more.end());
    Program server("edgesplat-server", server_arguments);
    EXPECT_TRUE(server.wait_for_stderr("ready", std::chrono::seconds(20)));
    std::vector<std::string> arguments = {"--replay", recording(), "--domain", domain, "--out", out()};
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
  [[nodiscard]] nlohmann::json metrics(const std::string& program) const {
    return nlohmann::json::parse(text_of(out() + "/" + program + "/metrics.json"));
  }
  [[nodiscard]] nlohmann::json counters(const std::string& program) const {
    return metrics(program)["counters"];
  }

 private:
  TempDir folder_;
};

}  // namespace edgesplat::test
