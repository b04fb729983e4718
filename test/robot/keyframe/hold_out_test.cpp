// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/hold_out.hpp"

#include "common/config/config_file.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace edgesplat::keyframe {
namespace {

/// Which of `count` pictures at 10 Hz, the first at 100 s, are held out.
std::vector<int> taken(const KeyframeConfig& config, int count) {
  HoldOut hold_out(config);
  std::vector<int> numbers;
  for (int i = 0; i < count; ++i) {
    if (hold_out.takes(HostTime(from_seconds(100.0) + i * std::chrono::milliseconds(100))))
      numbers.push_back(i);
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
  EXPECT_EQ(taken(config, 50), (std::vector<int>{5, 6, 7, 20, 21, 22}));
}

TEST(HoldOut, ABlockThatFallsIntoAnotherFollowsIt) {
  KeyframeConfig config;
  config.hold_out_from_s = {0.0, 0.1};
  config.hold_out_pictures = 2;
  EXPECT_EQ(taken(config, 9), (std::vector<int>{0, 1, 2, 3}));
}

TEST(HoldOut, BeginsThatDoNotAscendAreAnErrorOfTheConfiguration) {
  config::ConfigFile file;
  ASSERT_TRUE(file.apply_override("hold_out_from_s=[2.0, 1.0]"));
  KeyframeConfig config;
  EXPECT_FALSE(file.read_into(config));
}

}  // namespace
}  // namespace edgesplat::keyframe
