// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/step_back.hpp"

#include <sys/resource.h>

#include <gtest/gtest.h>

#include <unistd.h>
#include <algorithm>
#include <thread>

namespace edgesplat::thread {
namespace {

int niceness() {
  return ::getpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()));
}

TEST(StepBack, ConcernsTheCallingThreadAlone) {
  const int before = niceness();
  int there = 0;
  std::thread([&] {
    step_back();
    there = niceness();
  }).join();
  EXPECT_EQ(there, std::min(before + 5, 19));
  EXPECT_EQ(niceness(), before);
}

}  // namespace
}  // namespace edgesplat::thread
