// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/write_signals.hpp"

#include <csignal>

namespace edgesplat::thread {

void make_write_signals_errors() {
  (void)std::signal(SIGXFSZ, SIG_IGN);
  (void)std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace edgesplat::thread
