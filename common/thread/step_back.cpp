// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/thread/step_back.hpp"

#include <sys/resource.h>

#include <unistd.h>

namespace edgesplat::thread {

void step_back() {
  constexpr int kSteps = 5;
  const auto self = static_cast<id_t>(::gettid());
  // Beyond the greatest niceness the kernel stops by itself; more of it never needs a permission.
  (void)::setpriority(PRIO_PROCESS, self, ::getpriority(PRIO_PROCESS, self) + kSteps);
}

}  // namespace edgesplat::thread
