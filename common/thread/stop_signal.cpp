// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/stop_signal.hpp"

#include <pthread.h>
#include <unistd.h>

#include <csignal>

namespace edgesplat::thread {
namespace {

sigset_t watched_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGUSR2);  // wakes the waiter when the program ends by itself
  return signals;
}

}  // namespace

StopSignal::StopSignal() {
  const sigset_t signals = watched_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  waiter_ = std::jthread([this, signals](const std::stop_token& ended) {
    while (true) {
      int signal = 0;
      if (sigwait(&signals, &signal) != 0 || ended.stop_requested()) return;
      if (signal == SIGUSR2) continue;
      if (!source_.request_stop()) _exit(128 + signal);
    }
  });
}

StopSignal::~StopSignal() {
  waiter_.request_stop();
  pthread_kill(waiter_.native_handle(), SIGUSR2);
}

}  // namespace edgesplat::thread
