// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/link_metrics.hpp"

#include <gtest/gtest.h>

namespace edgesplat::link {
namespace {

TEST(LinkMetrics, EventsAreCountersAndWhatWaitsIsAGauge) {
  LinkCounters counters;
  LaneCounters& delta = counters[static_cast<std::size_t>(Lane::kDelta)];
  delta.messages_offered = 9;
  delta.messages_lost = 3;
  delta.queued_messages = 2;
  delta.queued_bytes = 500;
  metrics::Registry registry;
  record(registry, counters);
  EXPECT_EQ(registry.counter("link.delta.messages_offered").value(), 9U);
  EXPECT_EQ(registry.counter("link.delta.messages_lost").value(), 3U);
  EXPECT_EQ(registry.gauge("link.delta.queued_messages").value(), 2.0);
  EXPECT_EQ(registry.gauge("link.delta.queued_bytes").value(), 500.0);
}

TEST(LinkMetrics, UnusedLanesAreLeftOut) {
  metrics::Registry registry;
  record(registry, LinkCounters{});
  EXPECT_EQ(registry.to_json().find("link."), std::string::npos);
}

}  // namespace
}  // namespace edgesplat::link
