// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The robot program with two virtual LiDARs, each with an address, a serial number and a clock of its own,
// one of which is pulled while it drives.
#include "test/integration/live_lidar_run.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace edgesplat::test {
namespace {

std::string serial(int unit) {
  return "47M" + std::string(unit == 0 ? "A" : "B") + std::to_string(1'000'000'000 + ::getpid());
}

/// The second LiDAR's model; the first is a Mid-360.
class TwoLidarsRun : public LiveLidarRun {
 protected:
  TwoLidarsRun()
      : LiveLidarRun(shared_recording(std::string("corridor12_mid360_") + GetParam(),
                                      {"--world", "corridor", "--seconds", "12", "--pedestrians", "2",
                                       "--seed", "3", "--lidar", std::string("mid360,") + GetParam()})) {
    const std::string robot = own_loopback_address();
    std::ofstream config(in_folder("robot.toml"));
    for (const int unit : {0, 1}) {
      config << "[[livox]]\nmodel = \"" << (unit == 0 ? "mid360" : GetParam()) << "\"\nserial = \""
             << serial(unit) << "\"\nbind_address = \"" << robot << "\"\ncontrol_port = 0\n";
    }
  }

  void drive(const std::vector<std::string>& faults) {
    drive_with({"--config", in_folder("robot.toml"), "--record", in_folder("live.mcap")}, "listening unit=1",
               {"--lidar", std::string("mid360,") + GetParam(), "--lidar-serial", serial(0) + "," + serial(1),
                "--lidar-address", own_loopback_address() + "," + own_loopback_address(), "--lidar-drift-ppm",
                "30,-45"},
               faults);
  }
  /// How long a LiDAR was silent, by the line that says that its data are back.
  [[nodiscard]] double silence_s(const std::string& words) const {
    const std::size_t at = log_.find(words);
    return at == std::string::npos ? 1e9 : std::strtod(log_.c_str() + at + words.size(), nullptr);
  }
  [[nodiscard]] std::uint64_t counter(const std::string& name) const {
    const nlohmann::json& counters = metrics_.at("counters");
    EXPECT_TRUE(counters.contains(name)) << name;
    return counters.value(name, std::uint64_t{0});
  }
};

TEST_P(TwoLidarsRun, AreFoundStartedTrackedAndRecordedEachByItself) {
  drive({});
  EXPECT_TRUE(device_["lidar_asked"].get<bool>());
  for (const std::size_t unit : {0U, 1U}) {
    const std::string prefix = "livox_" + std::to_string(unit);
    EXPECT_EQ(counter(prefix + ".points.packets"), device_["lidars"][unit]["points_sent"]);
    EXPECT_EQ(counter(prefix + ".points.lost"), 0U);
    EXPECT_EQ(counter(prefix + ".found"), 1U);
    EXPECT_EQ(counter(prefix + ".silences"), 0U);
    EXPECT_EQ(counter(prefix + ".foreign_units"), 0U) << "the other is no stranger";
  }
  EXPECT_EQ(counter("livox.points.packets"), device_["points_sent"]);
  EXPECT_EQ(counter("sync.points.outs") + counter("sync.points_1.outs"), 0U);
  EXPECT_EQ(metrics_["gauges"]["sync.points.disciplined"].get<double>(), 1.0);
  EXPECT_EQ(metrics_["gauges"]["sync.points_1.disciplined"].get<double>(), 1.0);
  if (!kMustKeepUp) return;
  const double live_m = ate_m();
  std::printf("live, two: ATE %.1f mm\n", 1e3 * live_m);
  EXPECT_LT(live_m, 0.02);
  const auto replayed = run_program(
      "edgesplat-robot",
      {"--replay", in_folder("live.mcap"), "--lockstep", "--server", "off", "--out", in_folder("replayed")},
      std::chrono::seconds(300));
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_EQ(text_of(in_folder("replayed/robot/trajectory.tum")),
            text_of(in_folder("run/robot/trajectory.tum")));
}

TEST_P(TwoLidarsRun, ThePulledOneIsMissedByNobodyAndComesBack) {
  drive({"1:silence@5+2"});
  EXPECT_EQ(device_["lidars"][1]["faults"].get<int>(), 1);
  EXPECT_EQ(counter("livox_0.silences"), 0U);
  EXPECT_EQ(counter("livox_1.silences"), 1U);
  EXPECT_EQ(counter("livox_1.recoveries"), 1U);
  EXPECT_EQ(counter("sync.points.outs"), 0U);
  EXPECT_EQ(counter("sync.points_1.outs"), 1U);
  // One line for the event, and one for its end, which say whose.
  EXPECT_EQ(count_of("LiDAR fell silent", log_), 1U) << log_;
  EXPECT_EQ(count_of("LiDAR 1: points", log_), 1U) << log_;
  EXPECT_EQ(count_of("LiDAR data are back", log_), 1U);
  if (!kMustKeepUp) return;
  const double silent_s = silence_s("LiDAR 1: after ");
  std::printf("the second was pulled for 2 s and silent for %.2f s\n", silent_s);
  EXPECT_LT(silent_s, 2.0 + 3.0);
  const double live_m = ate_m();
  std::printf("live, the second pulled for 2 s: ATE %.1f mm\n", 1e3 * live_m);
  EXPECT_LT(live_m, 0.02);
}

TEST_P(TwoLidarsRun, WithoutTheFirstAndItsImuTheSecondCarriesTheTrack) {
  drive({"0:silence@5+2"});
  EXPECT_EQ(counter("livox_0.silences"), 1U);
  EXPECT_EQ(counter("livox_0.recoveries"), 1U);
  EXPECT_EQ(counter("livox_1.silences"), 0U);
  EXPECT_EQ(counter("sync.points.outs"), 1U);
  EXPECT_EQ(count_of("LiDAR fell silent", log_), 1U) << log_;
  if (!kMustKeepUp) return;
  const double live_m = ate_m();
  std::printf("live, the first and its IMU pulled for 2 s: ATE %.1f mm\n", 1e3 * live_m);
  EXPECT_LT(live_m, 0.10);
}

TEST_P(TwoLidarsRun, ARigAndAConfigurationOfDifferentNumbersAreRefused) {
  const auto run =
      run_program("edgesplat-robot", {"--live", "--rig", in_folder("rig.toml"), "--server", "off"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("give robot.toml a [[livox]] for each [[lidar]]"), std::string::npos) << run.err;
}

INSTANTIATE_TEST_SUITE_P(Second, TwoLidarsRun, testing::Values("mid360", "avia"),
                         [](const testing::TestParamInfo<const char*>& model) { return model.param; });

}  // namespace
}  // namespace edgesplat::test
