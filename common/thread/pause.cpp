// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/pause.hpp"

#include <condition_variable>
#include <mutex>

namespace edgesplat::thread {

void pause(const std::stop_token& stop, std::chrono::nanoseconds how_long) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  (void)never.wait_for(lock, stop, how_long, [] { return false; });
}

}  // namespace edgesplat::thread
