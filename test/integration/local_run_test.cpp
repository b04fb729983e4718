// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The robot's own mapping in whole runs: without a server's help, and until render latency asks for it.
#include "test/integration/offload_run_fixture.hpp"

#include <algorithm>
#include <string>

namespace edgesplat::test {
namespace {

class LocalRun : public OffloadRun {
 protected:
  /// PSNR of the run's map from places between its keyframes against the simulated world.
  static double score_db(const std::string& run_folder) {
    const auto scored = run_program("edgesplat", {"score", "--run", run_folder, "--input", recording(),
                                                  "--views", "6", "--lpips", run_folder + "/none", "--json"});
    EXPECT_EQ(scored.exit_code, 0) << scored.err;
    return nlohmann::json::parse(scored.out)["psnr_db"].get<double>();
  }
  /// A run of the robot alone, in virtual time.
  void map_alone(const std::string& run_folder, const std::string& steps) const {
    const auto robot =
        run_program("edgesplat-robot", {"--replay", recording(), "--lockstep", "--server", "off", "--out",
                                        run_folder, "--set", "local.lockstep_steps=" + steps});
    EXPECT_EQ(robot.exit_code, 0) << robot.err;
  }
};

TEST_F(LocalRun, StepsMakeTheRobotsOwnMapBetterAndLockstepRunsAreAlike) {
  map_alone(out() + "/seeded", "0");
  map_alone(out() + "/optimised", "8");
  map_alone(out() + "/again", "8");
  const std::string map = text_of(out() + "/optimised/robot/gaussians.ply");
  ASSERT_FALSE(map.empty());
  EXPECT_TRUE(map == text_of(out() + "/again/robot/gaussians.ply"));
  const double seeded_db = score_db(out() + "/seeded");
  const double optimised_db = score_db(out() + "/optimised");
  RecordProperty("seeded_db", std::to_string(seeded_db));
  RecordProperty("optimised_db", std::to_string(optimised_db));
  EXPECT_GT(optimised_db, seeded_db + 3.0);
}

TEST_F(LocalRun, WithOffloadNeverNothingGoesToTheServerAndWithAutoRenderLatencyAloneEndsLocal) {
  auto robot = run({"--offload", "never", "--set", "render.target_hz=15"}, {});
  ASSERT_EQ(robot.exit_code, 0) << robot.err;
  for (const auto& line : timeline()) EXPECT_EQ(line["mode"], "LOCAL");
  EXPECT_GT(counters("robot")["local.steps"].get<int>(), 0);  // how many is the machine's
  const double gaussians = metrics("robot")["gauges"]["local.gaussians"].get<double>();
  EXPECT_GT(gaussians, 5000.0);
  EXPECT_EQ(metrics("robot")["gauges"]["map.gaussians"].get<double>(), 0.0);
  EXPECT_EQ(counters("server")["map.keyframes"].get<int>(), 0);
  // A map at all: how good it gets in real time is the machine's; the test above holds the quality.
  EXPECT_GT(score_db(out()), 14.0);

  // Half of what a picture of that map took here: on any machine the growing map comes to it.
  const double threshold_ms = 0.5 * metrics("robot")["histograms"]["render.frame_ms"]["p50"].get<double>();
  ASSERT_GT(threshold_ms, 0.0);
  robot = run({"--offload", "auto", "--set", "offload.latency_threshold_ms=" + std::to_string(threshold_ms),
               "--set", "offload.memory_threshold_bytes=1e12", "--set", "offload.memory_reserve_bytes=0",
               "--set", "render.target_hz=15", "--set", "server.drain_s=20"},
              {});
  ASSERT_EQ(robot.exit_code, 0) << robot.err;
  EXPECT_NE(robot.err.find("mode=FULL reason=latency"), std::string::npos) << robot.err;
  EXPECT_EQ(robot.err.find("reason=memory"), std::string::npos);
  const auto lines = timeline();
  EXPECT_EQ(lines.front()["mode"], "LOCAL");
  const auto switched =
      std::find_if(lines.begin(), lines.end(), [](const auto& l) { return l["mode"] != "LOCAL"; });
  ASSERT_NE(switched, lines.end());
  EXPECT_GT((*switched)["render_p95_ms"].get<double>(), threshold_ms);
  // In the end the server has everything: nothing of the robot's own is left beside it.
  EXPECT_GT(counters("robot")["local.retired"].get<int>(), 100);
  EXPECT_EQ(metrics("robot")["gauges"]["local.gaussians"].get<double>(), 0.0);
  EXPECT_GT(metrics("robot")["gauges"]["map.gaussians"].get<double>(), 5000.0);
}

TEST_F(LocalRun, ShortOfMemoryAndWithoutALinkTheRobotPrunes) {
  const auto robot = run_program(
      "edgesplat-robot", {"--replay", recording(), "--domain", std::to_string(test_domain()), "--out", out(),
                          "--offload", "auto", "--set", "offload.memory_threshold_bytes=3e7", "--set",
                          "local.views_when_short=1", "--set", "server.drain_s=0.1"});
  ASSERT_EQ(robot.exit_code, 0) << robot.err;
  const auto lines = timeline();
  EXPECT_TRUE(
      std::any_of(lines.begin(), lines.end(), [](const auto& l) { return l["prune"].template get<bool>(); }));
  for (const auto& line : lines) EXPECT_EQ(line["mode"], "LOCAL");
  EXPECT_GT(counters("robot")["local.pruned"].get<int>(), 100);
  EXPECT_GT(counters("robot")["local.dropped_views"].get<int>(), 0);
  EXPECT_GT(metrics("robot")["gauges"]["local.gaussians"].get<double>(), 1000.0);
}

}  // namespace
}  // namespace edgesplat::test
