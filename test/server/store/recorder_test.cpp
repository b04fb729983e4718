// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "server/store/recorder.hpp"

#include "server/store/map_folder.hpp"
#include "test/common/io/file_size_limit.hpp"
#include "test/support/map_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>

namespace edgesplat::store {
namespace {

LoggedKeyframe keyframe(std::size_t bytes, std::byte value) {
  return {map::RobotId{3}, 77, std::vector<std::byte>(bytes, value)};
}

StoredMap sample(std::uint8_t name) {
  StoredMap map;
  map.map.bytes[0] = std::byte{name};
  map.robot.value = 3;
  map.gaussians = test::random_gaussians(500, 1);
  return map;
}

struct Bench {
  test::TempDir folder;
  SteadyClock clock;
  metrics::Registry registry;
  std::uint64_t count(const char* name) { return registry.counter(name).value(); }
};

TEST(Recorder, WritesWhatItWasGivenBeforeTheEnd) {
  Bench bench;
  {
    Recorder recorder({bench.folder.path(), {}}, bench.registry, bench.clock);
    for (int i = 0; i < 5; ++i) recorder.keyframe(keyframe(1000, std::byte(i)));
    EXPECT_TRUE(recorder.map(sample(1)));
    recorder.finish({sample(2)});
    recorder.keyframe(keyframe(1, std::byte{9}));  // too late: counted, no harm
  }
  EXPECT_EQ(bench.count("store.keyframes"), 5U);
  EXPECT_EQ(bench.count("store.keyframe_bytes"), 5000U);
  EXPECT_EQ(bench.count("store.keyframes_dropped"), 1U);
  EXPECT_EQ(bench.count("store.maps"), 2U);
  const auto log = KeyframeLog::open(bench.folder.path(), {});
  ASSERT_TRUE(log.has_value());
  ASSERT_EQ(log->size(), 5U);
  const auto fourth = log->read(3);
  ASSERT_TRUE(fourth.has_value());
  EXPECT_EQ(fourth->session, 77U);
  EXPECT_EQ(fourth->bytes, keyframe(1000, std::byte{3}).bytes);
  for (const std::uint8_t name : std::array<std::uint8_t, 2>{1, 2})
    EXPECT_TRUE(load_map(map_path(bench.folder.path(), map::RobotId{3}, sample(name).map)).has_value());
}

TEST(Recorder, NeverWaitsAndCountsWhatHasNoRoom) {
  Bench bench;
  RecorderConfig config{bench.folder.path(), {}};
  config.queue_bytes = 1000;
  Recorder recorder(config, bench.registry, bench.clock);
  for (int i = 0; i < 10; ++i) recorder.keyframe(keyframe(1001, std::byte{1}));  // larger than all the room
  recorder.finish();
  EXPECT_EQ(bench.count("store.keyframes_dropped"), 10U);
  EXPECT_EQ(bench.count("store.keyframes"), 0U);
}

TEST(Recorder, GoesOnWhenTheDiskIsFullAndWhenItIsNoMore) {
  Bench bench;
  {
    const io::FileSizeLimit full(100);
    Recorder recorder({bench.folder.path(), {}}, bench.registry, bench.clock);
    for (int i = 0; i < 3; ++i) recorder.keyframe(keyframe(1000, std::byte{1}));
    (void)recorder.map(sample(1));
    recorder.finish();
    ASSERT_FALSE(recorder.outcome());
    EXPECT_NE(recorder.outcome().error().context.find(".map"), std::string::npos);
  }
  EXPECT_EQ(bench.count("store.keyframes_failed"), 3U);
  EXPECT_EQ(bench.count("store.maps_failed"), 1U);
  EXPECT_EQ(bench.count("store.keyframes"), 0U);
  Recorder recorder({bench.folder.path(), {}}, bench.registry, bench.clock);
  recorder.keyframe(keyframe(1000, std::byte{1}));
  recorder.finish({sample(1)});
  EXPECT_TRUE(recorder.outcome());
  EXPECT_EQ(bench.count("store.keyframes"), 1U);
  EXPECT_EQ(bench.count("store.maps"), 1U);
}

TEST(Recorder, AFolderThatCannotBeMadeStopsNothing) {
  Bench bench;
  const auto file = bench.folder.path() / "file";
  std::ofstream(file) << "in the way";
  Recorder recorder({file / "store", {}}, bench.registry, bench.clock);
  recorder.keyframe(keyframe(10, std::byte{1}));
  recorder.finish({sample(1)});
  EXPECT_EQ(bench.count("store.keyframes_failed"), 1U);
  EXPECT_EQ(bench.count("store.maps_failed"), 1U);
}

}  // namespace
}  // namespace edgesplat::store
