// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The robot program with a virtual LiDAR that it has to find and to start, and that is pulled while it
// drives.
#include "test/integration/live_lidar_run.hpp"

namespace edgesplat::test {
namespace {

class LidarFaultRun : public LiveLidarRun {
 protected:
  LidarFaultRun()
      : LiveLidarRun(shared_recording(
            "corridor12", {"--world", "corridor", "--seconds", "12", "--pedestrians", "2", "--seed", "3"})) {}

  void drive(const std::vector<std::string>& faults) {
    const std::string serial = "47MR" + std::to_string(1'000'000'000 + ::getpid());
    // Addresses of its own: the usual ports are free there.
    drive_with({"--set", std::string("livox.model=") + GetParam(), "--set", "livox.serial=" + serial, "--set",
                "livox.bind_address=" + own_loopback_address(), "--set", "livox.control_port=0"},
               "listening",
               {"--lidar", GetParam(), "--lidar-serial", serial, "--lidar-address", own_loopback_address()},
               faults);
    counters_ = metrics_["counters"];
  }

  nlohmann::json counters_;
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
  drive({"silence@5+1.5", "address@9+0.1=" + own_loopback_address(), "loss@10.5+1=0.05"});
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
