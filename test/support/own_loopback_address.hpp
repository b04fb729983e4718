// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <atomic>
#include <string>

namespace edgesplat::test {

/// An address of this machine that no other test uses at the time: the port of a GigE Vision camera is fixed.
inline std::string own_loopback_address() {
  static std::atomic<int> next{1};
  const int pid = ::getpid();
  return "127." + std::to_string(16 + pid / 200 % 200) + "." + std::to_string(1 + pid % 200) + "." +
         std::to_string(next++);
}

}  // namespace edgesplat::test
