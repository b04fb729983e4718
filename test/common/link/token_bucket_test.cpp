// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/token_bucket.hpp"

#include <gtest/gtest.h>

namespace edgesplat::link {
namespace {

HostTime at(double seconds) {
  return HostTime(from_seconds(seconds));
}

TEST(TokenBucket, UnlimitedBeforeTheFirstEntry) {
  const TokenBucket bucket(at(10), {5.0}, {100.0}, 10);
  EXPECT_FALSE(bucket.rate_at(at(14.9)).has_value());
  EXPECT_EQ(bucket.ready_at(1'000'000, at(14.9)), at(14.9));
  EXPECT_EQ(bucket.rate_at(at(15)), 100.0);
}

TEST(TokenBucket, PassesExactlyTheRateOverTime) {
  TokenBucket bucket(at(0), {0.0}, {1000.0}, 100);
  HostTime t = at(0);
  for (int i = 0; i < 50; ++i) {
    t = bucket.ready_at(200, t);
    bucket.take(200, t);
  }
  // 50 x 200 B, of which the burst came for nothing.
  EXPECT_NEAR(to_seconds(t.time_since_epoch()), (50 * 200 - 100) / 1000.0, 1e-6);
}

TEST(TokenBucket, WalksThroughTheSchedule) {
  TokenBucket bucket(at(0), {0.0, 2.0, 4.0}, {100.0, 0.0, 1000.0}, 1);
  bucket.take(1, at(0));
  EXPECT_NEAR(to_seconds(bucket.ready_at(150, at(0)).time_since_epoch()), 1.5, 1e-6);
  EXPECT_NEAR(to_seconds(bucket.ready_at(300, at(0)).time_since_epoch()), 4.1, 1e-6);
  const TokenBucket closed(at(0), {0.0}, {0.0}, 1);
  EXPECT_EQ(closed.ready_at(2, at(1)), HostTime::max());
}

TEST(TokenBucket, UrgentTrafficUsesTokensOfWhatWaits) {
  TokenBucket bucket(at(0), {0.0}, {1000.0}, 1);
  bucket.take(1, at(0));
  for (int i = 1; i <= 9; ++i) bucket.take(10, at(0.1 * i), 1000);
  // 1000 B for the head and 90 B that overtook it.
  EXPECT_NEAR(to_seconds(bucket.ready_at(1000, at(0.95)).time_since_epoch()), 1.09, 1e-6);
}

}  // namespace
}  // namespace edgesplat::link
