// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// Short versions of the sequences of `tools/bench --tracking`, in every mode, against the exact truth.
#include "test/support/temp_dir.hpp"
#include "tools/accuracy/association.hpp"
#include "tools/accuracy/evaluation.hpp"
#include "tools/desk/odometry.hpp"
#include "tools/simulate/simulator.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace edgesplat::desk {
namespace {

struct Sequence {
  const char* name;
  const char* world;
  double seconds;
  double spin_radps;
  simulate::Lighting lighting;
  double lidar_ate_max_m;  ///< of LiDAR alone, which has to guess the motion within a turn
};

class SimulatedOdometry : public testing::TestWithParam<Sequence> {
 protected:
  void SetUp() override {
    simulate::SimulateOptions options;
    options.world.name = GetParam().world;
    options.seconds = GetParam().seconds;
    options.spin_radps = GetParam().spin_radps;
    options.lighting = GetParam().lighting;
    options.camera_width_px = 160;
    options.camera_height_px = 128;
    options.out = recording_;
    const auto report = simulate::simulate(options, {}, {});
    ASSERT_TRUE(report.has_value()) << report.error().context;
  }

  OdometryRun track(OdometryMode mode) const {
    OdometryJob job;
    job.lidar = recording_;
    job.mode = mode;
    const SteadyClock clock;
    auto run = run_odometry(job, clock, clock);
    EXPECT_TRUE(run.has_value()) << (run ? "" : run.error().context);
    return run ? *std::move(run) : OdometryRun{};
  }

  double ate_m(const OdometryRun& run) const {
    const auto truth = accuracy::read_recorded_truth(recording_);
    EXPECT_TRUE(truth.has_value());
    const auto evaluation = accuracy::evaluate(
        accuracy::associate_interpolated(run.poses, *truth, std::chrono::milliseconds(100)));
    EXPECT_TRUE(evaluation.has_value());
    return evaluation->absolute_m.rmse;
  }

  test::TempDir folder_;
  std::filesystem::path recording_ = folder_.path() / "a.mcap";
};

TEST_P(SimulatedOdometry, HoldsInEveryModeAndTheCameraDoesNoHarm) {
  const OdometryRun livo = track(OdometryMode::kLidarInertialVisual);
  const OdometryRun lio = track(OdometryMode::kLidarInertial);
  const OdometryRun lo = track(OdometryMode::kLidar);
  for (const OdometryRun* run : {&livo, &lio, &lo}) {
    EXPECT_EQ(run->coasted_groups, 0);
    EXPECT_GE(run->poses.size(), static_cast<std::size_t>(10.0 * GetParam().seconds) - 6);
  }
  RecordProperty("livo_ate_m", std::to_string(ate_m(livo)));
  RecordProperty("lio_ate_m", std::to_string(ate_m(lio)));
  RecordProperty("lo_ate_m", std::to_string(ate_m(lo)));
  EXPECT_LT(ate_m(lio), 0.006);
  EXPECT_LT(ate_m(livo), 1.1 * ate_m(lio) + 0.0005);
  EXPECT_LT(ate_m(lo), GetParam().lidar_ate_max_m);
}

using simulate::Lighting;
INSTANTIATE_TEST_SUITE_P(Sequences, SimulatedOdometry,
                         testing::Values(Sequence{"bare", "bare", 7.0, 0.0, Lighting::kSteady, 0.01},
                                         Sequence{"stairs", "stairs", 9.0, 0.0, Lighting::kSteady, 0.01},
                                         Sequence{"spin", "corridor", 8.0, std::numbers::pi,
                                                  Lighting::kSteady, 0.03},
                                         Sequence{"dark", "corridor", 11.0, 0.0, Lighting::kFailing, 0.01}),
                         [](const auto& sequence) { return std::string(sequence.param.name); });

}  // namespace
}  // namespace edgesplat::desk
