// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/pause.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace edgesplat::thread {
namespace {

using namespace std::chrono_literals;

TEST(Pause, LastsAsLongAsAsked) {
  const auto begin = std::chrono::steady_clock::now();
  pause({}, 20ms);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 20ms);
}

TEST(Pause, EndsWithAStop) {
  const auto begin = std::chrono::steady_clock::now();
  std::stop_source source;
  const std::jthread stopper([&source] {
    std::this_thread::sleep_for(10ms);
    source.request_stop();
  });
  pause(source.get_token(), 1h);
  pause(source.get_token(), 1h);  // a stop that came before
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10min);
}

}  // namespace
}  // namespace edgesplat::thread
