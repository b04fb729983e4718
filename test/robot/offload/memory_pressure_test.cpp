// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/offload/memory_pressure.hpp"

#include <gtest/gtest.h>

namespace edgesplat::offload {
namespace {

TEST(MemoryPressure, ReadsMemAvailable) {
  EXPECT_EQ(parse_available_bytes("MemTotal:       100 kB\nMemFree: 7 kB\nMemAvailable:     42 kB\n"),
            42U * 1024);
  EXPECT_FALSE(parse_available_bytes("").has_value());
  EXPECT_FALSE(parse_available_bytes("MemAvailable:").has_value());
  EXPECT_FALSE(parse_available_bytes("MemAvailable: x").has_value());
  EXPECT_FALSE(parse_available_bytes("MemAvailable: 99999999999999999999 kB").has_value());
}

TEST(MemoryPressure, IsThisProcessUntilTheMachineRunsShort) {
  EXPECT_EQ(memory_pressure_bytes(500, 1000, 200, 900), 500U);
  EXPECT_EQ(memory_pressure_bytes(500, std::nullopt, 200, 900), 500U);
  EXPECT_EQ(memory_pressure_bytes(500, 150, 200, 900), 950U);
  EXPECT_EQ(memory_pressure_bytes(5000, 150, 200, 900), 5000U);
}

TEST(MemoryPressure, IsMeasured) {
  EXPECT_GT(measured_memory_pressure_bytes(0, 1), 100'000U);
}

}  // namespace
}  // namespace edgesplat::offload
