// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/atomic_file.hpp"
#include "run_folder_maker.hpp"
#include "tools/report/report.hpp"
#include "tools/report/svg_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace edgesplat::report {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A run folder of which single files can be replaced, and its report.
class ModesReport : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("edgesplat_report_modes_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    ASSERT_TRUE(make_run_folder(folder_));
  }
  void write(const std::string& name, std::string_view text) {
    ASSERT_TRUE(io::write_file_atomically(folder_ / name, text));
  }
  void remove(const std::string& name) { std::filesystem::remove(folder_ / name); }
  void report() {
    const auto written = write_report({folder_, {}, 0});
    ASSERT_TRUE(written) << written.error().context;
    text_ = to_text(*written);
    missing_ = written->missing;
    page_ = io::read_text_file(folder_ / "report.html", 100'000'000).value_or("");
    summary_ =
        nlohmann::json::parse(io::read_text_file(folder_ / "summary.json", 1'000'000).value_or("null"));
  }

  std::filesystem::path folder_;
  std::string text_;
  std::string page_;
  std::vector<std::string> missing_;
  nlohmann::json summary_;
};

TEST_F(ModesReport, AWholeTimelineGivesItsFigures) {
  report();
  EXPECT_EQ(summary_["mode_seconds"], nlohmann::json({{"LOCAL", 4.0}, {"LEAN", 6.0}, {"FULL", 10.0}}));
  EXPECT_EQ(summary_["mode_switches"], 2);
  EXPECT_NEAR(summary_["bytes_up_per_s_full"], 200'000.0, 1e-6);
  EXPECT_NEAR(summary_["bytes_up_per_s_lean"], 40'000.0, 1e-6);
  EXPECT_NEAR(summary_["bytes_down_per_s"], 90'000.0, 1e-6);
  EXPECT_EQ(summary_["delta_latency_ms_p95"], 140.0);
  EXPECT_EQ(summary_["map_hash_match"], true);
  EXPECT_EQ(summary_["dropped"], nlohmann::json({{"robot.livox.points.lost", 6},
                                                 {"robot.livox.imu.lost", 1},
                                                 {"robot.tracking.coasted_groups", 2},
                                                 {"server.ingest.duplicates", 3}}));
  EXPECT_THAT(text_, HasSubstr("LOCAL 4.0 s, LEAN 6.0 s, FULL 10.0 s, 2 switches"));
  EXPECT_THAT(text_, HasSubstr("equal, 17 of 17 comparisons agreed"));
}

TEST_F(ModesReport, TheSectionShowsEveryCurve) {
  report();
  for (const char* text : {"<h2>Modes and link</h2>", "0 LOCAL, 1 LEAN, 2 FULL", "Render latency",
                           "Memory of the robot", "Bandwidth up", "shaped to", "Bytes since the start",
                           "Gaussians on the robot", "200.0 kB/s", "class=\"band\""}) {
    EXPECT_THAT(page_, HasSubstr(text));
  }
}

TEST_F(ModesReport, AbsenceIsSaidNotFatal) {
  for (const char* name : {"robot/modes.jsonl", "robot/metrics.json", "server/metrics.json"}) remove(name);
  report();
  EXPECT_THAT(page_, HasSubstr("The run has no time line of modes."));
  EXPECT_THAT(page_, HasSubstr("never compared"));
  for (const char* key : {"mode_seconds", "mode_switches", "bytes_up_per_s_full", "bytes_up_per_s_lean",
                          "bytes_down_per_s", "delta_latency_ms_p95", "map_hash_match", "dropped"}) {
    ASSERT_TRUE(summary_.contains(key)) << key;
    EXPECT_TRUE(summary_[key].is_null()) << key;
  }
}

TEST_F(ModesReport, HostileLinesAreSaid) {
  write("robot/modes.jsonl",
        "{\"t_s\":0,\"mode\":\"FULL\"}\n{\"t_s\"\n\"x\"\n{\"t_s\":9,\"mode\":\"FULL\"}\n");
  report();
  EXPECT_EQ(summary_["mode_seconds"]["FULL"], 9.0);
  EXPECT_TRUE(summary_["bytes_up_per_s_full"].is_null());
  EXPECT_THAT(missing_, testing::Contains("2 lines of modes.jsonl, first modes.jsonl:2: not a JSON object"));
  EXPECT_THAT(page_, Not(HasSubstr("Render latency")));  // no curve without a value
}

TEST_F(ModesReport, OneDisagreementIsNoMatch) {
  write("robot/metrics.json", R"({"counters": {"map.hash_agreed": 9, "map.hash_disagreed": 1}})");
  report();
  EXPECT_EQ(summary_["map_hash_match"], false);
  EXPECT_THAT(text_, HasSubstr("DIFFERENT, 9 of 10 comparisons agreed"));
}

TEST_F(ModesReport, NoComparisonIsNoAnswer) {
  write("robot/metrics.json", R"({"counters": {"map.hash_agreed": 0, "map.hash_disagreed": 0}})");
  report();
  EXPECT_TRUE(summary_["map_hash_match"].is_null());
  EXPECT_THAT(text_, HasSubstr("never compared"));
}

TEST_F(ModesReport, MetricsOfOtherTypesDoNoHarm) {
  write("robot/metrics.json", R"({"counters": [1, "lost"], "gauges": 3, "histograms": null})");
  write("server/metrics.json", R"({"counters": 7, "histograms": {"server.keyframe_to_delta_ms": "slow"}})");
  report();
  EXPECT_TRUE(summary_["delta_latency_ms_p95"].is_null());
  EXPECT_TRUE(summary_["map_hash_match"].is_null());
}

TEST(DrawBands, AreInTheLegendOnceAndOnTheCurvesScale) {
  Plot plot{"t", "x", "y", {{"s", kBlue, {0, 10}, {1, 2}}}};
  plot.bands = {
      {"<A>", kRed, 0.0, 5.0}, {"B", kGreen, 5.0, 7.5}, {"<A>", kRed, 7.5, 10.0}, {"", kBlue, 2, 1}};
  const std::string svg = draw(plot);
  EXPECT_EQ(svg.find("&lt;A&gt;"), svg.rfind("&lt;A&gt;"));
  std::vector<double> widths;
  for (std::size_t at = svg.find("class=\"band\""); at != std::string::npos;
       at = svg.find("class=\"band\"", at + 1)) {
    double x = 0.0;
    double y = 0.0;
    double width = 0.0;
    ASSERT_EQ(
        std::sscanf(svg.c_str() + at, "class=\"band\" x=\"%lf\" y=\"%lf\" width=\"%lf\"", &x, &y, &width), 3);
    widths.push_back(width);
  }
  ASSERT_EQ(widths.size(), 3U);  // the one that ends before it begins is left out
  EXPECT_NEAR(widths[0], 2.0 * widths[1], 0.2);
  EXPECT_NEAR(widths[1], widths[2], 0.2);
}

}  // namespace
}  // namespace edgesplat::report
