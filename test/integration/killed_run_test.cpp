// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The robot's program at 30 pictures a second while its server is killed and started again.
#include "common/io/trajectory_file.hpp"
#include "common/time/clock.hpp"
#include "test/integration/program.hpp"
#include "test/support/test_domain.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <sstream>
#include <thread>

namespace edgesplat::test {
namespace {

using namespace std::chrono_literals;

class KilledRun : public ::testing::Test {
 protected:
  [[nodiscard]] std::string out() const { return folder_.path() / "run"; }
  /// Behind everything else that runs on this machine.
  [[nodiscard]] std::unique_ptr<ChildProcess> nice_server() const {
    return std::make_unique<ChildProcess>(
        std::vector<std::string>{"/usr/bin/nice", "-n", "10",
                                 std::string(EDGESPLAT_BINARY_DIR) + "/bin/edgesplat-server", "--domain",
                                 std::to_string(test_domain()), "--out", out()},
        ChildOutput{folder_.path() / "server.out", folder_.path() / "server.err"});
  }
  /// Intervals between pictures of which the later began between the two times, in ms, ascending.
  [[nodiscard]] std::vector<double> intervals_ms(HostTime from, HostTime to) const {
    std::istringstream lines(text_of(out() + "/robot/frames.csv"));
    std::string line;
    std::getline(lines, line);  // the names
    std::vector<double> intervals;
    double before_s = 0.0;
    while (std::getline(lines, line)) {
      const double began_s = std::stod(line);
      if (before_s > 0.0 && began_s > to_seconds(from.time_since_epoch()) &&
          began_s <= to_seconds(to.time_since_epoch()))
        intervals.push_back(1e3 * (began_s - before_s));
      before_s = began_s;
    }
    std::sort(intervals.begin(), intervals.end());
    return intervals;
  }
  [[nodiscard]] double longest_gap_between_poses_s() const {
    const auto poses = io::read_tum(out() + "/robot/trajectory.tum");
    EXPECT_TRUE(poses && poses->size() > 100);
    double longest_s = 0.0;
    for (std::size_t i = 1; poses && i < poses->size(); ++i)
      longest_s = std::max(longest_s, to_seconds((*poses)[i].stamp - (*poses)[i - 1].stamp));
    return longest_s;
  }

  TempDir folder_;
  SteadyClock clock_;
};

TEST_F(KilledRun, PicturesAndPosesGoOnAndTheHashesAgreeAgain) {
  const std::string recording = shared_recording(
      "corridor15", {"--world", "corridor", "--seconds", "15", "--pedestrians", "2", "--seed", "5"});
  auto server = nice_server();
  Program robot("edgesplat-robot", {"--replay", recording, "--domain", std::to_string(test_domain()), "--out",
                                    out(), "--set", "render.target_hz=30", "--set", "server.drain_s=20"});
  ASSERT_TRUE(robot.wait_for_stderr("mode=FULL", 30s));
  std::this_thread::sleep_for(2s);
  server->signal(SIGKILL);
  const HostTime killed = clock_.now();
  ASSERT_EQ(server->wait(20s), 128 + SIGKILL);
  std::this_thread::sleep_for(5s);
  server = nice_server();
  const ProgramResult run = robot.wait(120s);
  server->signal(SIGTERM);
  EXPECT_EQ(server->wait(30s), 0);
  ASSERT_EQ(run.exit_code, 0) << run.err;

  const auto intervals = intervals_ms(killed, killed + 5s);
  ASSERT_GT(intervals.size(), 50U) << "at least ten pictures a second, whatever else runs here";
  const double p99_ms = intervals[intervals.size() * 99 / 100];
  std::printf("%zu pictures in the 5 s after the kill; interval p50 %.1f, p99 %.1f, most %.1f ms\n",
              intervals.size(), intervals[intervals.size() / 2], p99_ms, intervals.back());
  EXPECT_LT(longest_gap_between_poses_s(), 0.15) << "no pose is missing";
  EXPECT_NE(run.err.find("mode=LOCAL"), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("did not answer everything"), std::string::npos) << run.err;
  const auto counters = nlohmann::json::parse(text_of(out() + "/robot/metrics.json"))["counters"];
  EXPECT_EQ(counters["map.hash_disagreed"].get<int>(), 0);
  EXPECT_GE(counters["map.resets"].get<int>(), 1);  // the server's new epoch
  EXPECT_GT(counters["map.hash_agreed"].get<int>(), 0);
}

}  // namespace
}  // namespace edgesplat::test
