// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <source_location>

namespace edgesplat {

/// Prints the failed condition with its place to stderr and aborts; systemd restarts the program.
[[noreturn]] void check_failed(const char* condition, const char* why, std::source_location where);

}  // namespace edgesplat

/// For bugs only, never for bytes, files or devices: those return an Error.
#define EDGESPLAT_CHECK(condition, why)                                                            \
  do {                                                                                             \
    if (!(condition)) ::edgesplat::check_failed(#condition, why, std::source_location::current()); \
  } while (false)
