// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

namespace edgesplat::test {

/// A DDS domain of this process's own, so that tests that run side by side do not meet. Under 100: the ports
/// of higher ones lie among the kernel's ephemeral ports.
inline int test_domain() {
  return 1 + static_cast<int>(::getpid() % 97);
}

}  // namespace edgesplat::test
