// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/offload/mode_timeline.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace edgesplat::offload {
namespace {

TEST(ModeTimeline, ALineHasEveryFieldAndNullForTheUnknown) {
  OffloadRecord record;
  record.at = HostTime(std::chrono::seconds(12));
  record.situation.now = record.at;
  auto line = nlohmann::json::parse(timeline_line(record, HostTime(std::chrono::seconds(10))));
  EXPECT_EQ(line["t_s"], 2.0);
  EXPECT_EQ(line["mode"], "LOCAL");
  for (const char* unknown : {"render_p95_ms", "memory_bytes", "bandwidth_bytes_per_s",
                              "true_bandwidth_bytes_per_s", "round_trip_ms", "heartbeat_age_s"}) {
    ASSERT_TRUE(line.contains(unknown)) << unknown;
    EXPECT_TRUE(line[unknown].is_null()) << unknown;
  }
  record.decision = {policy::Mode::kLean, policy::Reason::kLatency, true, false};
  record.situation.render_p95_ms = 41.5;
  record.situation.bandwidth_bytes_per_s = std::numeric_limits<double>::infinity();
  record.situation.last_heartbeat = HostTime(std::chrono::milliseconds(11500));
  record.shaped_bytes_per_s = 125e3;
  record.bytes_up = 77;
  record.draining = true;
  line = nlohmann::json::parse(timeline_line(record, HostTime{}));
  EXPECT_EQ(line["mode"], "LEAN");
  EXPECT_EQ(line["reason"], "latency");
  EXPECT_EQ(line["changed"], true);
  EXPECT_EQ(line["render_p95_ms"], 41.5);
  EXPECT_TRUE(line["bandwidth_bytes_per_s"].is_null());
  EXPECT_EQ(line["true_bandwidth_bytes_per_s"], 125e3);
  EXPECT_EQ(line["heartbeat_age_s"], 0.5);
  EXPECT_EQ(line["bytes_up"], 77);
  EXPECT_EQ(line["draining"], true);
}

TEST(ModeTimeline, AFileThatCannotBeWrittenDoesNoHarm) {
  ModeTimeline nowhere("/proc/nowhere/modes.jsonl", HostTime{});
  nowhere.add({});
  nowhere.add({});
  ModeTimeline unwanted({}, HostTime{});
  unwanted.add({});
}

}  // namespace
}  // namespace edgesplat::offload
