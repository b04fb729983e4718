// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/hold_out.hpp"

#include "common/config/config_file.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace edgesplat::keyframe {
namespace {

using Taken = std::vector<std::pair<int, int>>;

/// Which of `count` pictures at 10 Hz, the first at 100 s, are held out, and in which block.
Taken taken(const KeyframeConfig& config, int count) {
  HoldOut hold_out(config);
  Taken numbers;
  for (int i = 0; i < count; ++i) {
    const auto block = hold_out.block_of(HostTime(from_seconds(100.0) + i * std::chrono::milliseconds(100)));
    if (block) numbers.emplace_back(i, *block);
  }
  return numbers;
}

TEST(HoldOut, TakesNothingUnlessAsked) {
  EXPECT_TRUE(taken(KeyframeConfig{}, 50).empty());
}

TEST(HoldOut, TakesBlocksOfPicturesInARow) {
  KeyframeConfig config;
  config.hold_out_from_s = {0.5, 2.0};
  config.hold_out_pictures = 3;
  EXPECT_EQ(taken(config, 50), (Taken{{5, 0}, {6, 0}, {7, 0}, {20, 1}, {21, 1}, {22, 1}}));
}

TEST(HoldOut, ABlockThatFallsIntoAnotherFollowsIt) {
  KeyframeConfig config;
  config.hold_out_from_s = {0.0, 0.1};
  config.hold_out_pictures = 2;
  EXPECT_EQ(taken(config, 9), (Taken{{0, 0}, {1, 0}, {2, 1}, {3, 1}}));
}

TEST(HoldOut, BeginsThatDoNotAscendAreAnErrorOfTheConfiguration) {
  config::ConfigFile file;
  ASSERT_TRUE(file.apply_override("hold_out_from_s=[2.0, 1.0]"));
  KeyframeConfig config;
  EXPECT_FALSE(file.read_into(config));
}

}  // namespace
}  // namespace edgesplat::keyframe
