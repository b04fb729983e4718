// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/dds_transport.hpp"
#include "common/link/heartbeat.hpp"
#include "test/integration/program.hpp"
#include "test/support/test_domain.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <set>
#include <sstream>
#include <thread>

namespace edgesplat::test {
namespace {

/// A server of a later version, as far as a robot can see.
class LaterServer {
 public:
  explicit LaterServer(int domain) {
    link::LinkConfig config;
    config.domain = domain;
    transport_ = *link::open_dds_transport(*link::DdsDomain::open(config),
                                           {link::Role::kServer, map::RobotId{0}, 0}, clock_);
    heartbeats_ = std::jthread([this](const std::stop_token& stop) { speak(stop); });
  }

 private:
  void speak(const std::stop_token& stop) {
    link::Heartbeat heartbeat;
    heartbeat.epoch.value = 1;
    auto bytes = link::encode_heartbeat(heartbeat);
    bytes[4] = std::byte{2};         // the version
    bytes.resize(bytes.size() + 4);  // and what it may have more
    while (!stop.stop_requested()) {
      (void)transport_->send(link::Lane::kHeartbeat, map::RobotId{1}, bytes);
      (void)transport_->receive(std::chrono::milliseconds(100));  // paces
    }
  }

  SteadyClock clock_;
  std::unique_ptr<link::Transport> transport_;
  std::jthread heartbeats_;
};

TEST(WrongVersion, TheRobotSaysWhichVersionsMeetOnceAndStaysLocal) {
  const TempDir folder;
  const LaterServer server(test_domain());
  const std::string recording = shared_recording(
      "corridor6", {"--world", "corridor", "--seconds", "6", "--pedestrians", "2", "--seed", "3"});
  const std::string out = folder.path() / "run";
  const auto robot =
      run_program("edgesplat-robot", {"--replay", recording, "--domain", std::to_string(test_domain()),
                                      "--out", out, "--seconds", "3", "--set", "server.drain_s=0.1"});
  ASSERT_EQ(robot.exit_code, 0) << robot.err;
  const std::string words = "the other end speaks version 2, this program version 1: update the older one";
  const auto said = robot.err.find(words);
  ASSERT_NE(said, std::string::npos) << robot.err;
  EXPECT_EQ(robot.err.find(words, said + 1), std::string::npos) << "once is enough";
  std::istringstream lines(text_of(out + "/robot/modes.jsonl"));
  std::set<std::string> modes;
  for (std::string line; std::getline(lines, line);) modes.insert(nlohmann::json::parse(line)["mode"]);
  EXPECT_EQ(modes, std::set<std::string>{"LOCAL"});
}

}  // namespace
}  // namespace edgesplat::test
