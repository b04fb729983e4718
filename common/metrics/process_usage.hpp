// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace edgesplat::metrics {

/// What this process costs the machine.
struct ProcessUsage {
  std::uint64_t rss_bytes = 0;       ///< resident now (VmRSS)
  std::uint64_t peak_rss_bytes = 0;  ///< resident at most so far (VmHWM)
  double cpu_s = 0.0;                ///< user and system time of all threads
};

/// Reads /proc/self/status and CLOCK_PROCESS_CPUTIME_ID; zeros where they cannot be read.
[[nodiscard]] ProcessUsage process_usage();

/// The memory fields of the text of /proc/<pid>/status.
[[nodiscard]] ProcessUsage parse_proc_status(std::string_view text);

}  // namespace edgesplat::metrics
