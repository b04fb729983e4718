// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// A recording of two LiDARs with free clocks of their own, tracked in virtual time: as well as with one.
#include "test/integration/program.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>

namespace edgesplat::test {
namespace {

class TwoLidarsReplay : public testing::Test {
 protected:
  TwoLidarsReplay() {
    recording_ = shared_recording(
        "corridor12_two_free", {"--world", "corridor", "--seconds", "12", "--pedestrians", "2", "--seed", "3",
                                "--lidar", "mid360,avia", "--clock", "free"});
  }
  [[nodiscard]] std::string in_folder(const std::string& name) const { return folder_.path() / name; }

  /// Error of the trajectory; `more` go to the robot.
  double track(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"--replay", recording_, "--lockstep",  "--server",
                                          "off",      "--out",    in_folder(out)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto run = run_program("edgesplat-robot", std::move(arguments), std::chrono::seconds(300));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    metrics_ = nlohmann::json::parse(text_of(in_folder(out) + "/robot/metrics.json"));
    const auto report =
        run_program("edgesplat", {"report", "--run", in_folder(out), "--input", recording_, "--json"});
    EXPECT_EQ(report.exit_code, 0) << report.err;
    const auto summary = nlohmann::json::parse(report.out);
    return summary["ate_rmse_m"].is_number() ? summary["ate_rmse_m"].get<double>() : 1e9;
  }

  std::string recording_;
  nlohmann::json metrics_;

 private:
  TempDir folder_;
};

TEST_F(TwoLidarsReplay, TracksAsWellAsWithOne) {
  const auto extracted = run_program(
      "edgesplat", {"inspect", recording_, "--extract", "rig.toml", "--to", in_folder("two.toml")});
  ASSERT_EQ(extracted.exit_code, 0) << extracted.err;
  // The rig without its second LiDAR: what begins with the second [[lidar]] up to [imu] goes.
  std::string rig = text_of(in_folder("two.toml"));
  const std::size_t first = rig.find("[[lidar]]");
  ASSERT_NE(first, std::string::npos) << rig;
  const std::size_t second = rig.find("[[lidar]]", first + 1);
  const std::size_t imu = rig.find("[imu]");
  ASSERT_TRUE(second != std::string::npos && imu != std::string::npos && second < imu);
  rig = rig.substr(0, second) + rig.substr(imu);
  std::ofstream(in_folder("one.toml")) << rig;

  const double one_m = track("one", {"--rig", in_folder("one.toml")});
  EXPECT_GT(metrics_["counters"]["sync.bad_values"].get<int>(), 10'000)
      << "the second's packets are nobody's";
  const double two_m = track("two");
  std::printf("virtual time, free clocks: ATE %.1f mm with one LiDAR, %.1f mm with two\n", 1e3 * one_m,
              1e3 * two_m);
  EXPECT_LT(two_m, 0.02);
  EXPECT_LT(two_m, 1.5 * one_m + 0.001);
  const auto& counters = metrics_["counters"];
  const auto& gauges = metrics_["gauges"];
  EXPECT_GT(counters["sync.points.in_groups"].get<int>(), 1'000'000);
  EXPECT_GT(counters["sync.points_1.in_groups"].get<int>(), 1'000'000);
  EXPECT_EQ(counters["sync.late_points"].get<int>(), 0);
  EXPECT_EQ(counters["sync.points_1.outs"].get<int>(), 0);
  EXPECT_EQ(gauges["sync.points_1.disciplined"].get<double>(), 0.0);
  EXPECT_NE(gauges["sync.points_1.drift_ppm"].get<double>(), gauges["sync.points.drift_ppm"].get<double>());
}

TEST_F(TwoLidarsReplay, GivesTheSameBitsEachTime) {
  (void)track("once");
  (void)track("again", {"--threads", "2"});
  EXPECT_EQ(text_of(in_folder("once/robot/trajectory.tum")),
            text_of(in_folder("again/robot/trajectory.tum")));
}

}  // namespace
}  // namespace edgesplat::test
