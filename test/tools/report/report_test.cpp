// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/report.hpp"

#include "common/io/atomic_file.hpp"
#include "run_folder_maker.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace edgesplat::report {
namespace {

std::filesystem::path folder_named(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / ("edgesplat_report_" + name);
}

std::string read(const std::filesystem::path& path) {
  return io::read_text_file(path, 100'000'000).value_or("");
}

/// The page without its embedded pictures, in whose base64 any word may occur.
std::string text_of_page(const std::filesystem::path& folder) {
  std::string page = read(folder / "report.html");
  for (std::size_t begin = page.find("base64,"); begin != std::string::npos;
       begin = page.find("base64,", begin)) {
    begin += std::string_view("base64,").size();
    page.erase(begin, page.find('"', begin) - begin);
  }
  return page;
}

TEST(WriteReport, AWholeRunGivesItsFigures) {
  const auto folder = folder_named("whole");
  const Status made = make_run_folder(folder);
  ASSERT_TRUE(made) << made.error().context;
  const auto report = write_report({folder, {}, 4});
  ASSERT_TRUE(report) << report.error().context;
  EXPECT_TRUE(report->missing.empty()) << report->missing.front();

  const nlohmann::json summary = nlohmann::json::parse(read(folder / "summary.json"));
  EXPECT_EQ(summary["poses"], 200);
  EXPECT_NEAR(summary["duration_s"], 19.9, 1e-6);
  // The drift of 0.01 m/s in x; alignment takes its mean and some of its slope away, the end keeps all of it.
  EXPECT_NEAR(summary["ete_m"], 0.199, 1e-3);
  EXPECT_GT(summary["ate_rmse_m"], 0.02);
  EXPECT_LT(summary["ate_rmse_m"], 0.06);
  EXPECT_NEAR(summary["track_ms_p50"], 18.0, 1.0);
  EXPECT_GT(summary["track_ms_p95"], summary["track_ms_p50"]);
  EXPECT_NEAR(summary["pose_stream_hz"], 200.0, 1.0);
  EXPECT_EQ(summary["pose_latency_ms_p99"], 2.5);
  EXPECT_NEAR(summary["realtime_factor"], 19.9 / (200 * 0.0183), 0.3);
  EXPECT_EQ(summary["packets_lost"], 7);
  EXPECT_EQ(summary["gaussians"], 52300);
  EXPECT_EQ(summary["keyframes"], 40);
  EXPECT_EQ(summary["robot_peak_rss_mb"], 250);
  EXPECT_EQ(summary["server_peak_rss_mb"], 512);
  EXPECT_EQ(summary["bytes_up"], 3000000);
  EXPECT_TRUE(summary["bytes_down"].is_null());
  EXPECT_NEAR(summary["render_psnr_db"], 20 * std::log10(255.0 / 5.0),
              1.0);  // pictures differ by 5 everywhere
  EXPECT_EQ(summary["references"][0]["name"], "truth");
}

TEST(WriteReport, ThePageStandsAlone) {
  const auto folder = folder_named("page");
  ASSERT_TRUE(make_run_folder(folder));
  ASSERT_TRUE(write_report({folder, {}, 2}));
  const std::string page = text_of_page(folder);
  for (const char* text :
       {"<h2>Trajectory</h2>", "<h2>Point map</h2>", "<h2>Camera and Gaussians</h2>",
        "<h2>What tracking saw</h2>", "initialising 0.4 s, tracking 17.5 s, degraded 2.0 s",
        "Directions left to the IMU", "keyframe 000011: 2 of 3 patches used", "<h2>Times and rates</h2>",
        "<h2>Drops and losses</h2>", "<h2>Settings</h2>", "livox.points.lost", "&lt;test &amp; rig&gt;"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
  for (const char* text : {"<script", "http", "nan", "inf\""}) {
    EXPECT_EQ(page.find(text), std::string::npos) << text;
  }
  EXPECT_LT(std::filesystem::file_size(folder / "report.html"), 3'000'000U);
}

TEST(WriteReport, AnOffsetIsNoTimeOfAStage) {
  const auto folder = folder_named("stages");
  ASSERT_TRUE(make_run_folder(folder));
  ASSERT_TRUE(write_report({folder, {}, 1}));
  const std::string page = text_of_page(folder);
  EXPECT_NE(page.find("keyframe</"), std::string::npos);
  EXPECT_EQ(page.find("lidar_delay"), std::string::npos);
}

TEST(WriteReport, OffsetsStandWhereTheyWereEstimated) {
  const auto folder = folder_named("offsets");
  ASSERT_TRUE(make_run_folder(folder));
  ASSERT_TRUE(write_report({folder, {}, 1}));
  EXPECT_EQ(text_of_page(folder).find("found by tracking"), std::string::npos);
  ASSERT_TRUE(io::write_file_atomically(
      folder / "robot" / "metrics.json",
      std::string_view(R"({"gauges": {"tracking.lidar_delay_ms": -7.93, "tracking.lidar_delay_sigma_ms": 0.21,
        "tracking.lidar_delay_frozen": 1, "tracking.camera_delay_ms": 3.0, "tracking.camera_delay_sigma_ms": 0,
        "tracking.lidar_step_x_mm": 12.0, "tracking.lidar_step_y_mm": -4.0, "tracking.lidar_step_z_mm": 0.5,
        "tracking.lidar_step_sigma_mm": 6.0, "tracking.lidar_step_frozen": 1}})")));
  ASSERT_TRUE(write_report({folder, {}, 1}));
  const std::string page = text_of_page(folder);
  for (const char* text : {"found by tracking", "LiDAR later than its stamps, ms", "-7.93", "0.21",
                           "at the end", "12.0, -4.0, 0.5", "1 of 3 directions at the end"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_EQ(page.find("camera later than its stamps"), std::string::npos);  // held
}

TEST(WriteReport, AnEmptyFolderIsSaidNotFatal) {
  const auto folder = folder_named("empty");
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const auto report = write_report({folder, {}, 4});
  ASSERT_TRUE(report) << report.error().context;
  EXPECT_GE(report->missing.size(), 6U);
  const nlohmann::json summary = nlohmann::json::parse(read(folder / "summary.json"));
  for (const char* key :
       {"ate_rmse_m", "ete_m", "path_m", "track_ms_p50", "track_ms_p95", "realtime_factor", "packets_lost",
        "gaussians", "keyframes", "bytes_up", "bytes_down", "robot_peak_rss_mb", "server_peak_rss_mb"}) {
    ASSERT_TRUE(summary.contains(key)) << key;
    EXPECT_TRUE(summary[key].is_null()) << key;
  }
  EXPECT_NE(text_of_page(folder).find("What this report lacks"), std::string::npos);
}

TEST(WriteReport, DamagedPiecesAreSaidNotFatal) {
  const auto folder = folder_named("damaged");
  ASSERT_TRUE(make_run_folder(folder));
  for (const char* name : {"robot/metrics.json", "robot/groups.csv", "robot/points.ply",
                           "robot/keyframes/000011.jpg", "robot/trajectory.tum"}) {
    ASSERT_TRUE(io::write_file_atomically(folder / name, std::string_view("a,b\n1,2,3\n")));
  }
  const auto report = write_report({folder, {}, 4});
  ASSERT_TRUE(report) << report.error().context;
  EXPECT_GE(report->missing.size(), 5U);
}

TEST(WriteReport, PseudoPosesBesideTheInputAreReferences) {
  const auto folder = folder_named("pseudo");
  ASSERT_TRUE(make_run_folder(folder));
  std::filesystem::remove(folder / "truth.tum");
  const auto input = folder_named("pseudo_input");
  std::filesystem::create_directories(input);
  std::string poses;
  for (int i = 0; i < 200; ++i) {
    poses += "1 0 0 " + std::to_string(0.12 * i) + " 0 1 0 " + std::to_string(3.0 * std::sin(0.025 * i)) +
             " 0 0 1 0.6\n";
  }
  ASSERT_TRUE(io::write_file_atomically(input / "poses_one_pseudo.txt", poses));
  ASSERT_TRUE(io::write_file_atomically(input / "poses_two_pseudo.txt", poses));
  const auto report = write_report({folder, input, 4});
  ASSERT_TRUE(report) << report.error().context;
  ASSERT_EQ(report->references.size(), 2U);
  EXPECT_EQ(report->references[0].name, "poses_one_pseudo");
  EXPECT_EQ(report->references[0].evaluation.pairs, 200U);
  EXPECT_NEAR(*report->summary.ete_m, 0.199, 1e-3);
}

TEST(WriteReport, LiveStampsAreBroughtToTheRecordingsTime) {
  const auto folder = folder_named("live");
  ASSERT_TRUE(make_run_folder(folder));
  auto trajectory = io::read_tum(folder / "robot" / "trajectory.tum");
  ASSERT_TRUE(trajectory);
  for (auto& pose : *trajectory) pose.stamp += from_seconds(5000.25);
  ASSERT_TRUE(io::write_tum(folder / "robot" / "trajectory.tum", *trajectory));
  EXPECT_FALSE(write_report({folder, {}, 0})->summary.ate_rmse_m);
  ASSERT_TRUE(io::write_file_atomically(folder / "stream.json",
                                        std::string_view("{\"host_minus_recording_s\": 5000.25}\n")));
  const auto report = write_report({folder, {}, 0});
  ASSERT_TRUE(report->summary.ete_m);
  EXPECT_NEAR(*report->summary.ete_m, 0.199, 1e-3);
}

TEST(WriteReport, WithoutAFolderIsAnError) {
  const auto report = write_report({folder_named("never_made"), {}, 4});
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, Errc::kNotFound);
}

}  // namespace
}  // namespace edgesplat::report
