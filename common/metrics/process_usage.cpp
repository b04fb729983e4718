// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/process_usage.hpp"

#include <charconv>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string>

namespace edgesplat::metrics {
namespace {

/// "VmRSS:\t  1234 kB" -> bytes; 0 where the field is absent.
std::uint64_t field_bytes(std::string_view text, std::string_view name) {
  std::size_t line = 0;
  while (line < text.size() && text.substr(line, name.size()) != name) {
    const std::size_t end = text.find('\n', line);
    if (end == std::string_view::npos) return 0;
    line = end + 1;
  }
  if (line >= text.size()) return 0;
  const std::size_t digits = text.find_first_of("0123456789", line + name.size());
  if (digits == std::string_view::npos) return 0;
  std::uint64_t kilobytes = 0;
  (void)std::from_chars(text.data() + digits, text.data() + text.size(), kilobytes);
  return kilobytes * 1024;
}

}  // namespace

ProcessUsage parse_proc_status(std::string_view text) {
  ProcessUsage usage;
  usage.rss_bytes = field_bytes(text, "VmRSS:");
  usage.peak_rss_bytes = field_bytes(text, "VmHWM:");
  return usage;
}

ProcessUsage process_usage() {
  std::ifstream file("/proc/self/status");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  ProcessUsage usage = parse_proc_status(text);
  timespec spent{};
  if (::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &spent) == 0)
    usage.cpu_s = static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
  return usage;
}

}  // namespace edgesplat::metrics
