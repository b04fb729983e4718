// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/gvcp_probe.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

namespace edgesplat::aravis {
namespace {

std::vector<std::byte> good_answer() {
  std::vector<std::byte> answer(8 + 0xF8);
  answer[3] = std::byte{0x03};
  answer[5] = std::byte{0xF8};
  answer[7] = std::byte{0x01};
  return answer;
}

TEST(GvcpProbe, OnlyAWholeDiscoveryAnswerCounts) {
  const auto good = good_answer();
  EXPECT_TRUE(is_discovery_answer(good));
  for (std::size_t i = 0; i < 8; ++i) {
    auto bad = good;
    bad[i] ^= std::byte{1};
    EXPECT_FALSE(is_discovery_answer(bad)) << i;
  }
  EXPECT_FALSE(is_discovery_answer(std::span(good).first(good.size() - 1)));
  EXPECT_FALSE(is_discovery_answer({}));
}

TEST(GvcpProbe, NobodyThereIsNoWithinTheTimeout) {
  const GvcpProbe probe("127.251.251.251");
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(probe.answers({}, std::chrono::milliseconds(50)));
  EXPECT_FALSE(
      probe.answers({}, std::chrono::milliseconds(50)));  // the refusal of the first is no answer either
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
}

TEST(GvcpProbe, ANameIsNoAddress) {
  EXPECT_FALSE(GvcpProbe("front camera").answers({}, std::chrono::milliseconds(1)));
}

}  // namespace
}  // namespace edgesplat::aravis
