// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/ingest/ingest.hpp"

#include "common/map/keyframe_codec.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

namespace edgesplat::ingest {
namespace {

link::Message message(std::uint16_t robot, std::uint64_t session, std::uint32_t id) {
  return {link::Lane::kKeyframe, map::RobotId{robot}, session,
          *map::encode_keyframe(test::random_keyframe(id, 5, id))};
}

class IngestTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::uint64_t count(const char* name) { return registry_.counter(name).value(); }
  metrics::Registry registry_;
  Ingest ingest_{registry_, 2};
};

TEST_F(IngestTest, TakesEachKeyframeOnce) {
  const auto first = ingest_.take(message(1, 10, 0), HostTime(nanoseconds(77)));
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->robot, map::RobotId{1});
  EXPECT_EQ(first->received, HostTime(nanoseconds(77)));
  EXPECT_EQ(first->keyframe.points_in_body.size(), 5U);
  EXPECT_FALSE(ingest_.take(message(1, 10, 0), HostTime{}).has_value());
  EXPECT_TRUE(ingest_.take(message(1, 10, 2), HostTime{}).has_value());
  EXPECT_TRUE(ingest_.take(message(1, 10, 1), HostTime{}).has_value());  // late is not twice
  EXPECT_EQ(count("ingest.keyframes"), 3U);
  EXPECT_EQ(count("ingest.duplicates"), 1U);
}

TEST_F(IngestTest, RemembersOverAVeryLongRun) {
  for (std::uint32_t id = 0; id < 6000; ++id)
    ASSERT_TRUE(ingest_.take(message(1, 10, id), HostTime{}).has_value());
  for (const std::uint32_t id : {0U, 1000U, 5999U}) {
    EXPECT_FALSE(ingest_.take(message(1, 10, id), HostTime{}).has_value());
  }
}

TEST_F(IngestTest, ARestartedRobotStartsOverAndItsPastIsStale) {
  EXPECT_TRUE(ingest_.take(message(1, 10, 0), HostTime{}).has_value());
  EXPECT_TRUE(ingest_.take(message(1, 11, 0), HostTime{}).has_value());
  EXPECT_FALSE(ingest_.take(message(1, 10, 1), HostTime{}).has_value());
  EXPECT_EQ(count("ingest.stale"), 1U);
}

TEST_F(IngestTest, ServesABoundedNumberOfRobots) {
  EXPECT_TRUE(ingest_.take(message(1, 10, 0), HostTime{}).has_value());
  EXPECT_TRUE(ingest_.take(message(2, 20, 0), HostTime{}).has_value());
  EXPECT_FALSE(ingest_.take(message(3, 30, 0), HostTime{}).has_value());
  EXPECT_EQ(count("ingest.refused"), 1U);
}

TEST_F(IngestTest, CorruptBytesAreCountedAndChangeNothing) {
  auto bad = message(1, 10, 0);
  bad.bytes[20] ^= std::byte{1};
  EXPECT_FALSE(ingest_.take(bad, HostTime{}).has_value());
  EXPECT_EQ(count("ingest.corrupt"), 1U);
  EXPECT_TRUE(ingest_.take(message(1, 10, 0), HostTime{}).has_value());
}

}  // namespace
}  // namespace edgesplat::ingest
