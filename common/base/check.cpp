// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace edgesplat {

void check_failed(const char* condition, const char* why, std::source_location where) {
  std::fprintf(stderr, "edgesplat: bug at %s:%u: %s (%s)\n", where.file_name(), where.line(), condition, why);
  std::abort();
}

}  // namespace edgesplat
