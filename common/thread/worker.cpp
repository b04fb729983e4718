// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/worker.hpp"

#include <pthread.h>

namespace edgesplat::thread {
namespace {

void run(const std::stop_token& stop, const std::string& name, const Worker::Step& step) noexcept {
  constexpr std::size_t kKernelNameLength = 15;  // pthread_setname_np(3)
  (void)::pthread_setname_np(::pthread_self(), name.substr(0, kKernelNameLength).c_str());
  while (!stop.stop_requested()) {
    if (!step(stop)) return;
  }
}

}  // namespace

Worker::Worker(std::string name, Step step)
    : name_(std::move(name)), thread_([name = name_, step = std::move(step)](const std::stop_token& stop) {
        run(stop, name, step);
      }) {}

}  // namespace edgesplat::thread
