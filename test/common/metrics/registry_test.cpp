// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/registry.hpp"

#include "common/metrics/process_usage.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <thread>
#include <vector>

namespace edgesplat::metrics {
namespace {

TEST(Registry, TheSameNameIsTheSameMetric) {
  Registry registry;
  Counter& lost = registry.counter("livox.lost_packets");
  lost.add(2);
  for (int i = 0; i < 100; ++i) (void)registry.counter("other" + std::to_string(i));
  registry.counter("livox.lost_packets").add();
  EXPECT_EQ(lost.value(), 3U);
}

TEST(Registry, WritesJson) {
  Registry registry;
  registry.counter("frames").add(7);
  registry.gauge("queue_bytes").set(12.5);
  registry.gauge("broken").set(std::nan(""));
  registry.histogram("group_ms").record(4.0);
  registry.gauge("not utf-8 \xff").set(1.0);
  const auto json = nlohmann::json::parse(registry.to_json());
  EXPECT_EQ(json["counters"]["frames"], 7);
  EXPECT_EQ(json["gauges"]["queue_bytes"], 12.5);
  EXPECT_TRUE(json["gauges"]["broken"].is_null());
  EXPECT_EQ(json["histograms"]["group_ms"]["count"], 1);
  EXPECT_EQ(json["histograms"]["group_ms"]["p95"], 4.0);
  EXPECT_GT(json["process"]["rss_bytes"].get<std::uint64_t>(), 0U);
}

TEST(Registry, CanBeUsedFromSeveralThreads) {
  Registry registry;
  std::vector<std::thread> threads;
  threads.reserve(3);
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&registry] {
      for (int i = 0; i < 500; ++i) {
        registry.counter("n").add();
        registry.histogram("h" + std::to_string(i % 5)).record(i);
      }
    });
  (void)registry.to_json();
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(registry.counter("n").value(), 1500U);
}

TEST(ProcessUsage, ReadsTheStatusFile) {
  const ProcessUsage usage =
      parse_proc_status("Name:\tx\nVmPeak:\t  99 kB\nVmHWM:\t    2048 kB\nVmRSS:\t    1024 kB\n");
  EXPECT_EQ(usage.rss_bytes, 1024U * 1024U);
  EXPECT_EQ(usage.peak_rss_bytes, 2048U * 1024U);
}

TEST(ProcessUsage, SurvivesAnyText) {
  for (const char* text : {"", "\n", "VmRSS:", "VmRSS:\n", "VmRSS: kB", "VmRSS: 99999999999999999999999 kB"})
    EXPECT_EQ(parse_proc_status(text).rss_bytes, 0U) << text;
}

TEST(ProcessUsage, SeesThisProcess) {
  const ProcessUsage usage = process_usage();
  EXPECT_GT(usage.rss_bytes, 100U * 1024U);
  EXPECT_GE(usage.peak_rss_bytes, usage.rss_bytes / 2);
  EXPECT_GT(usage.cpu_s, 0.0);
}

}  // namespace
}  // namespace edgesplat::metrics
