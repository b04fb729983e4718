// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/worker.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <array>
#include <atomic>
#include <stdexcept>
#include <vector>

namespace edgesplat::thread {
namespace {

TEST(Worker, ConsumesUntilTheQueueIsClosedAndDrained) {
  BoundedQueue<int> queue({.items = 100}, Overflow::kBlock);
  std::vector<int> seen;
  {
    Worker worker = Worker::consume<int>("consumer", queue, [&seen](int item) { seen.push_back(item); });
    for (int i = 0; i < 50; ++i) queue.push(i);
    queue.close();
    worker.join();
  }
  ASSERT_EQ(seen.size(), 50U);
  EXPECT_EQ(seen.back(), 49);
}

TEST(Worker, DestructionStopsAndJoinsAWorkerThatWaits) {
  BoundedQueue<int> queue({.items = 1}, Overflow::kBlock);
  std::atomic<int> handled = 0;
  {
    const Worker worker = Worker::consume<int>("waits", queue, [&handled](int) { ++handled; });
  }
  EXPECT_EQ(handled, 0);
}

TEST(Worker, RunsItsStepUntilItSaysStop) {
  int steps = 0;
  Worker worker("steps", [&steps](const std::stop_token&) { return ++steps < 3; });
  worker.join();
  worker.join();
  EXPECT_EQ(steps, 3);
}

TEST(Worker, ThreadCarriesTheNameCutToTheKernelsLength) {
  std::array<char, 16> name{};
  Worker worker("tracking-and-more", [&name](const std::stop_token&) {
    (void)::pthread_getname_np(::pthread_self(), name.data(), name.size());
    return false;
  });
  worker.join();
  EXPECT_STREQ(name.data(), "tracking-and-mo");
  EXPECT_EQ(worker.name(), "tracking-and-more");
}

TEST(WorkerDeathTest, AnExceptionEndsTheProgram) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_DEATH(
      {
        Worker worker("throws", [](const std::stop_token&) -> bool { throw std::runtime_error("boom"); });
        worker.join();
      },
      "boom");
}

}  // namespace
}  // namespace edgesplat::thread
