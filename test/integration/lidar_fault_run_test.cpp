// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The robot program with a virtual LiDAR that it has to find and to start, and that is pulled while it
// drives.
#include "test/integration/program.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <string>

namespace edgesplat::test {
namespace {

/// Under a sanitizer the robot may be too slow to follow live sensors.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMustKeepUp = false;
#else
constexpr bool kMustKeepUp = true;
#endif

std::size_t count_of(const std::string& words, const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

class LidarFaultRun : public testing::TestWithParam<const char*> {
 protected:
  LidarFaultRun() {
    recording_ = shared_recording(
        "corridor12", {"--world", "corridor", "--seconds", "12", "--pedestrians", "2", "--seed", "3"});
    const auto extracted = run_program(
        "edgesplat", {"inspect", recording_, "--extract", "rig.toml", "--to", in_folder("rig.toml")});
    EXPECT_EQ(extracted.exit_code, 0) << extracted.err;
  }
  [[nodiscard]] std::string in_folder(const std::string& name) const { return folder_.path() / name; }
  /// An address that no other test on this machine has at the same time.
  static std::string address(int last) {
    return "127." + std::to_string(10 + ::getpid() / 256 % 200) + "." + std::to_string(::getpid() % 256) +
           "." + std::to_string(last);
  }
  static std::string serial() { return "47MR" + std::to_string(1'000'000'000 + ::getpid()); }

  /// Drives through the recording with these faults of the LiDAR.
  void drive(const std::vector<std::string>& faults) {
    // Addresses of its own: the usual ports are free there.
    Program robot("edgesplat-robot",
                  {"--live", "--rig", in_folder("rig.toml"), "--server", "off", "--out", in_folder("run"),
                   "--set", std::string("livox.model=") + GetParam(), "--set", "livox.serial=" + serial(),
                   "--set", "livox.bind_address=" + address(1), "--set", "livox.control_port=0",
                   "--frame-port", std::to_string(20'000 + ::getpid() % 10'000)});
    ASSERT_TRUE(robot.wait_for_stderr("listening", std::chrono::seconds(20)));
    std::vector<std::string> stream = {"stream",          recording_,
                                       "--lidar",         GetParam(),
                                       "--lidar-serial",  serial(),
                                       "--lidar-address", address(10),
                                       "--frame-port",    std::to_string(20'000 + ::getpid() % 10'000),
                                       "--json"};
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
    counters_ = nlohmann::json::parse(text_of(in_folder("run/robot/metrics.json")))["counters"];
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
  nlohmann::json counters_;

 private:
  TempDir folder_;
};

TEST_P(LidarFaultRun, FindsStartsAndTracksWithoutLoss) {
  drive({});
  EXPECT_TRUE(device_["lidar_asked"].get<bool>());
  EXPECT_EQ(counters_["livox.points.packets"], device_["points_sent"]);
  EXPECT_EQ(counters_["livox.imu.packets"], device_["imu_sent"]);
  EXPECT_EQ(counters_["livox.points.lost"].get<int>(), 0);
  EXPECT_EQ(counters_["livox.kernel_dropped"].get<int>(), 0);
  EXPECT_EQ(counters_["livox.found"].get<int>(), 1);
  if (kMustKeepUp) {
    EXPECT_LT(ate_m(), 0.02);
  }
}

TEST_P(LidarFaultRun, PulledMovedAndLossyItComesBackAndTheTrackHolds) {
  drive({"silence@5+1.5", "address@9+0.1=" + address(11), "loss@10.5+1=0.05"});
  EXPECT_EQ(device_["lidar"]["faults"].get<int>(), 3);
  EXPECT_GE(counters_["livox.silences"].get<int>(), 2);
  EXPECT_EQ(counters_["livox.recoveries"], counters_["livox.silences"]);
  EXPECT_EQ(counters_["livox.moves"].get<int>(), 1);
  EXPECT_GT(counters_["livox.points.lost"].get<int>(), 50);
  // Each event is one line.
  EXPECT_EQ(count_of("LiDAR fell silent", log_), counters_["livox.silences"].get<std::size_t>()) << log_;
  EXPECT_EQ(count_of("LiDAR data are back", log_), counters_["livox.recoveries"].get<std::size_t>());
  EXPECT_EQ(count_of("LiDAR has another address", log_), 1U);
  if (kMustKeepUp) {
    EXPECT_LT(ate_m(), 0.10);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, LidarFaultRun, testing::Values("mid360", "avia"),
                         [](const testing::TestParamInfo<const char*>& model) { return model.param; });

}  // namespace
}  // namespace edgesplat::test
