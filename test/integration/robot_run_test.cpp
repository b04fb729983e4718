// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The robot program on a short simulated recording: what it writes, that it is deterministic, and how it
// meets bad input.
#include "test/integration/program.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace edgesplat::test {
namespace {

/// A short recording and a folder to write in.
class RobotRun : public testing::Test {
 protected:
  static std::string recording() {
    return shared_recording("corridor6",
                            {"--world", "corridor", "--seconds", "6", "--pedestrians", "2", "--seed", "3"});
  }
  [[nodiscard]] std::string in_folder(const std::string& name) const { return folder_.path() / name; }

 private:
  TempDir folder_;
};

TEST_F(RobotRun, LockstepGivesTheSameBitsWithOneAndTwoThreads) {
  std::string trajectories[3];
  const char* threads[3] = {"1", "2", "2"};
  for (int i = 0; i < 3; ++i) {
    const std::string out = in_folder("lockstep" + std::to_string(i));
    const auto run = run_program("edgesplat-robot", {"--replay", recording(), "--lockstep", "--threads",
                                                     threads[i], "--server", "off", "--out", out});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    trajectories[i] = text_of(out + "/robot/trajectory.tum");
  }
  EXPECT_GT(std::count(trajectories[0].begin(), trajectories[0].end(), '\n'), 40);
  EXPECT_EQ(trajectories[0], trajectories[1]);
  EXPECT_EQ(trajectories[1], trajectories[2]);
}

TEST_F(RobotRun, WritesEverythingARunFolderHas) {
  const std::string out = in_folder("whole");
  const auto run = run_program("edgesplat-robot",
                               {"--replay", recording(), "--speed", "0", "--server", "off", "--out", out});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* file :
       {"rig.toml", "robot.toml", "robot/trajectory.tum", "robot/metrics.json", "robot/groups.csv",
        "robot/points.ply", "robot/gaussians.ply", "robot/keyframes/000000.jpg",
        "robot/keyframes/000000.json", "robot/keyframes/000000_overlay.png", "robot/renders/000000.png"}) {
    EXPECT_TRUE(std::filesystem::exists(out + "/" + file)) << file;
  }
  const auto metrics = nlohmann::json::parse(text_of(out + "/robot/metrics.json"));
  EXPECT_GT(metrics["counters"]["keyframes.made"].get<int>(), 5);
  EXPECT_EQ(metrics["counters"]["queue.measurements.dropped"].get<int>(), 0);
  EXPECT_GT(metrics["gauges"]["map.coloured_points"].get<double>(), 1000);
}

TEST_F(RobotRun, TheReplayVerbGivesTheSameTrajectory) {
  const auto robot = run_program("edgesplat-robot", {"--replay", recording(), "--lockstep", "--server", "off",
                                                     "--out", in_folder("robot")});
  const auto verb =
      run_program("edgesplat", {"replay", recording(), "--lockstep", "--out", in_folder("verb")});
  ASSERT_EQ(robot.exit_code, 0) << robot.err;
  ASSERT_EQ(verb.exit_code, 0) << verb.err;
  EXPECT_EQ(text_of(in_folder("robot/robot/trajectory.tum")),
            text_of(in_folder("verb/robot/trajectory.tum")));
}

TEST_F(RobotRun, TruncatedRecordingKeepsWhatIsReadableAndSaysHowMuch) {
  const std::string cut = in_folder("cut.mcap");
  std::filesystem::copy_file(recording(), cut, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::resize_file(cut, std::filesystem::file_size(cut) * 2 / 3);
  const std::string out = in_folder("cut");
  const auto run =
      run_program("edgesplat-robot", {"--replay", cut, "--lockstep", "--server", "off", "--out", out});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("truncated"), std::string::npos) << run.err;
  const auto poses = text_of(out + "/robot/trajectory.tum");
  EXPECT_GT(std::count(poses.begin(), poses.end(), '\n'), 20);
}

TEST_F(RobotRun, MissingRecordingIsExitCode1AndNamesIt) {
  const auto run = run_program("edgesplat-robot", {"--replay", "/nowhere/rec.mcap", "--server", "off"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("/nowhere/rec.mcap"), std::string::npos) << run.err;
}

TEST_F(RobotRun, UnknownConfigKeyIsExitCode2WithFileAndLine) {
  const std::string config = in_folder("bad.toml");
  std::ofstream(config) << "[tracking]\nmax_iteratons = 4\n\n[keyframe]\ntranslation_m = \"far\"\n";
  const auto run = run_program("edgesplat-robot", {"--config", config, "--check-config"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("bad.toml:2"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("bad.toml:5"), std::string::npos) << run.err;
}

TEST_F(RobotRun, PrintedConfigLoadsAgain) {
  const auto printed = run_program("edgesplat-robot", {"--print-config"});
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  const std::string config = in_folder("printed.toml");
  std::ofstream(config) << printed.out;
  const auto again = run_program("edgesplat-robot", {"--config", config, "--print-config"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out, printed.out);
}

TEST_F(RobotRun, UsageErrorsAreExitCode2) {
  EXPECT_EQ(run_program("edgesplat-robot", {}).exit_code, 2);
  EXPECT_EQ(run_program("edgesplat-robot", {"--live", "--lockstep"}).exit_code, 2);
  EXPECT_EQ(run_program("edgesplat-robot", {"--no-such-option"}).exit_code, 2);
  EXPECT_EQ(run_program("edgesplat-robot", {"--help"}).exit_code, 0);
}

TEST_F(RobotRun, FolderOfTheWrongLayoutIsExplained) {
  const std::string wrong = in_folder("wrong_layout");
  std::filesystem::create_directories(wrong);
  std::ofstream(wrong + "/notes.txt") << "nothing to see";
  const auto run = run_program("edgesplat-robot", {"--replay", wrong, "--server", "off"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.err.find("velodyne"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace edgesplat::test
