// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "test/integration/program.hpp"
#include "test/support/own_loopback_address.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <string>
#include <utility>
#include <vector>

namespace edgesplat::test {

inline std::size_t count_of(const std::string& words, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

/// The robot program with virtual LiDARs that play a recording; a parameter is a LiDAR's model.
class LiveLidarRun : public testing::TestWithParam<const char*> {
 protected:
  explicit LiveLidarRun(std::string recording) : recording_(std::move(recording)) {
    const auto extracted = run_program(
        "edgesplat", {"inspect", recording_, "--extract", "rig.toml", "--to", in_folder("rig.toml")});
    EXPECT_EQ(extracted.exit_code, 0) << extracted.err;
  }
  [[nodiscard]] std::string in_folder(const std::string& name) const { return folder_.path() / name; }

  /// Drives through the recording with these faults of the LiDARs; the robot is ready when it said `ready`.
  void drive_with(const std::vector<std::string>& robot_options, const std::string& ready,
                  const std::vector<std::string>& device_options, const std::vector<std::string>& faults) {
    const std::string frame_port = std::to_string(20'000 + ::getpid() % 10'000);
    std::vector<std::string> start = {"--live", "--rig",          in_folder("rig.toml"), "--server", "off",
                                      "--out",  in_folder("run"), "--frame-port",        frame_port};
    start.insert(start.end(), robot_options.begin(), robot_options.end());
    Program robot("edgesplat-robot", std::move(start));
    ASSERT_TRUE(robot.wait_for_stderr(ready, std::chrono::seconds(20)));
    std::vector<std::string> stream = {"stream", recording_, "--frame-port", frame_port, "--json"};
    stream.insert(stream.end(), device_options.begin(), device_options.end());
    for (const std::string& fault : faults) {
      stream.emplace_back("--lidar-fault");
      stream.push_back(fault);
    }
    const auto streamed = run_program("edgesplat", std::move(stream));
    robot.signal(SIGTERM);
    const auto run = robot.wait(std::chrono::seconds(60));
    ASSERT_EQ(streamed.exit_code, 0) << streamed.err;
    ASSERT_EQ(run.exit_code, 0) << run.err;
    log_ = run.err;
    device_ = nlohmann::json::parse(streamed.out);
    metrics_ = nlohmann::json::parse(text_of(in_folder("run/robot/metrics.json")));
  }
  [[nodiscard]] double ate_m() const {
    const auto accuracy =
        run_program("edgesplat", {"report", "--run", in_folder("run"), "--input", recording_, "--json"});
    EXPECT_EQ(accuracy.exit_code, 0) << accuracy.err;
    const auto summary = nlohmann::json::parse(accuracy.out);
    return summary["ate_rmse_m"].is_number() ? summary["ate_rmse_m"].get<double>() : 1e9;
  }

  std::string recording_;
  std::string log_;
  nlohmann::json device_;
  nlohmann::json metrics_;

 private:
  TempDir folder_;
};

}  // namespace edgesplat::test
