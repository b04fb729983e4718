// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/mode_timeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::report {
namespace {

/// A line as the robot writes it, with values easy to tell apart.
std::string line_of(double t_s, const std::string& mode, double bytes_up, double bytes_down) {
  return R"({"t_s":)" + std::to_string(t_s) + R"(,"mode":")" + mode +
         R"(","reason":"bandwidth","changed":false,"prune":false,"render_p95_ms":21.5,"memory_bytes":3e8,)"
         R"("bandwidth_bytes_per_s":null,"true_bandwidth_bytes_per_s":250000.0,"round_trip_ms":4.0,)"
         R"("heartbeat_age_s":0.1,"bytes_up":)" +
         std::to_string(bytes_up) + R"(,"bytes_down":)" + std::to_string(bytes_down) + "}\n";
}

ModeTimeline parse(const std::string& text) {
  return parse_mode_timeline(text, "modes.jsonl");
}

TEST(ModeTimeline, ReadsWhatTheRobotWrites) {
  const ModeTimeline timeline = parse(line_of(0.5, "LEAN", 100, 20));
  ASSERT_EQ(timeline.samples.size(), 1U);
  EXPECT_EQ(timeline.skipped, 0U);
  const ModeSample& sample = timeline.samples.front();
  EXPECT_EQ(sample.t_s, 0.5);
  EXPECT_EQ(sample.mode, RunMode::kLean);
  EXPECT_EQ(sample.render_p95_ms, 21.5);
  EXPECT_EQ(sample.memory_bytes, 3e8);
  EXPECT_TRUE(std::isnan(sample.bandwidth_bytes_per_s));
  EXPECT_EQ(sample.true_bandwidth_bytes_per_s, 250000.0);
  EXPECT_EQ(sample.bytes_up, 100.0);
  EXPECT_EQ(sample.bytes_down, 20.0);
  EXPECT_TRUE(std::isnan(sample.gaussians));
}

TEST(ModeTimeline, FiguresOfAKnownRun) {
  // 2 s LOCAL, 4 s FULL at 1000 bytes/s, 1 s LEAN at 100 bytes/s, down 50 bytes/s all the time.
  const ModeTimeline timeline =
      parse(line_of(1, "LOCAL", 0, 0) + line_of(3, "FULL", 0, 100) + line_of(5, "FULL", 2000, 200) +
            line_of(7, "LEAN", 4000, 300) + line_of(8, "LEAN", 4100, 350));
  const ModeFigures figures = figures_of(timeline);
  EXPECT_THAT(figures.seconds, testing::ElementsAre(2.0, 1.0, 4.0));
  EXPECT_EQ(figures.switches, 2U);
  EXPECT_EQ(figures.bytes_up_per_s[index_of(RunMode::kLocal)], 0.0);
  EXPECT_EQ(figures.bytes_up_per_s[index_of(RunMode::kLean)], 100.0);
  EXPECT_EQ(figures.bytes_up_per_s[index_of(RunMode::kFull)], 1000.0);
  EXPECT_EQ(figures.bytes_down_per_s, 50.0);
}

TEST(ModeTimeline, WhatIsSentAfterTheEndOfTheInputIsNoMean) {
  std::string last = line_of(3, "LEAN", 9000, 0);
  last.insert(last.size() - 2, R"(,"draining":true)");
  const ModeFigures figures = figures_of(parse(line_of(0, "LEAN", 0, 0) + line_of(2, "LEAN", 100, 0) + last));
  EXPECT_EQ(figures.bytes_up_per_s[index_of(RunMode::kLean)], 50.0);
  EXPECT_EQ(figures.seconds[index_of(RunMode::kLean)], 3.0);
}

TEST(ModeTimeline, SpansMergeEqualModesAndTouch) {
  const auto spans = spans_of(parse(line_of(0, "FULL", 0, 0) + line_of(1, "FULL", 0, 0) +
                                    line_of(2, "LOCAL", 0, 0) + line_of(4, "LOCAL", 0, 0)));
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_EQ(spans[0].mode, RunMode::kFull);
  EXPECT_EQ(spans[0].begin_s, 0.0);
  EXPECT_EQ(spans[0].end_s, 2.0);
  EXPECT_EQ(spans[1].mode, RunMode::kLocal);
  EXPECT_EQ(spans[1].begin_s, 2.0);
  EXPECT_EQ(spans[1].end_s, 4.0);
}

TEST(ModeTimeline, NothingIsKnownOfAnEmptyOne) {
  const ModeTimeline timeline = parse("\n\n");
  EXPECT_EQ(timeline.skipped, 0U);
  EXPECT_TRUE(spans_of(timeline).empty());
  EXPECT_FALSE(figures_of(timeline).bytes_down_per_s);
  const ModeFigures one = figures_of(parse(line_of(0, "FULL", 5, 5)));
  EXPECT_EQ(one.seconds[index_of(RunMode::kFull)], 0.0);
  EXPECT_FALSE(one.bytes_up_per_s[index_of(RunMode::kFull)]);
}

TEST(ModeTimeline, HostileLinesAreSkippedAndCounted) {
  const std::string good = line_of(2, "FULL", 10, 10);
  const std::vector<std::string> hostile = {
      good.substr(0, good.size() / 2) + "\n",    // cut off
      "[1, 2]\n",                                // no object
      "{\"t_s\": 3}\n",                          // no mode
      "{\"t_s\": 3, \"mode\": 7}\n",             // a mode of another type
      "{\"t_s\": 3, \"mode\": \"TURBO\"}\n",     // an unknown mode
      "{\"t_s\": null, \"mode\": \"FULL\"}\n",   // no time
      "{\"t_s\": 1e300, \"mode\": \"FULL\"}\n",  // a time beyond any run
      "{\"t_s\": -1, \"mode\": \"FULL\"}\n",     // before the start
      "{\"t_s\": 1, \"mode\": \"FULL\"}\n",      // back in time
      std::string(100'000, '[') + "\n",          // deep nesting, too long
      std::string(3000, '[') + "\n",             // deep nesting
      std::string("\0\xff\xfe{}", 5) + "\n"};    // no text
  for (const std::string& bad : hostile) {
    const ModeTimeline timeline = parse(good + bad + line_of(4, "FULL", 30, 10));
    EXPECT_EQ(timeline.samples.size(), 2U) << bad.substr(0, 60);
    EXPECT_EQ(timeline.skipped, 1U) << bad.substr(0, 60);
    EXPECT_EQ(timeline.first_skipped.rfind("modes.jsonl:2: ", 0), 0U) << timeline.first_skipped;
    EXPECT_EQ(figures_of(timeline).bytes_up_per_s[index_of(RunMode::kFull)], 10.0);
  }
}

TEST(ModeTimeline, AbsurdValuesAreNotKnownAndCountersThatGoBackAreLeftOut) {
  const ModeTimeline absurd =
      parse(R"({"t_s":1,"mode":"FULL","bytes_up":-5,"memory_bytes":1e308,"render_p95_ms":"fast"})");
  ASSERT_EQ(absurd.samples.size(), 1U);
  EXPECT_TRUE(std::isnan(absurd.samples[0].bytes_up));
  EXPECT_TRUE(std::isnan(absurd.samples[0].memory_bytes));
  EXPECT_TRUE(std::isnan(absurd.samples[0].render_p95_ms));
  const ModeFigures figures =
      figures_of(parse(line_of(0, "FULL", 0, 0) + line_of(1, "FULL", 70, 0) + line_of(2, "FULL", 5, 0)));
  EXPECT_EQ(figures.bytes_up_per_s[index_of(RunMode::kFull)], 70.0);  // the second that can be told
  EXPECT_EQ(figures.seconds[index_of(RunMode::kFull)], 2.0);
}

TEST(ModeTimeline, EveryTruncationIsReadAsFarAsItGoes) {
  const std::string text = line_of(0, "FULL", 0, 0) + line_of(1, "LEAN", 70, 0) + line_of(2, "FULL", 90, 0);
  for (std::size_t length = 0; length < text.size(); ++length) {
    const ModeTimeline timeline = parse(text.substr(0, length));
    EXPECT_LE(timeline.samples.size(), 3U);
    EXPECT_LE(timeline.skipped, 1U) << length;
  }
}

TEST(ModeTimeline, IsBoundedInLines) {
  std::string text;
  for (std::size_t i = 0; i < ModeTimeline::kMaxSamples + 3; ++i) text += "{\"t_s\":1,\"mode\":\"FULL\"}\n";
  const ModeTimeline timeline = parse(text);
  EXPECT_EQ(timeline.samples.size(), ModeTimeline::kMaxSamples);
  EXPECT_EQ(timeline.skipped, 3U);
}

}  // namespace
}  // namespace edgesplat::report
