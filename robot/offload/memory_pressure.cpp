// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/offload/memory_pressure.hpp"

#include "common/metrics/process_usage.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <string>

namespace edgesplat::offload {

std::optional<std::uint64_t> parse_available_bytes(std::string_view meminfo) {
  constexpr std::string_view kName = "MemAvailable:";
  std::size_t at = meminfo.find(kName);
  if (at == std::string_view::npos) return std::nullopt;
  at += kName.size();
  while (at < meminfo.size() && meminfo[at] == ' ') ++at;
  std::uint64_t kilobytes = 0;
  const auto [end, error] = std::from_chars(meminfo.data() + at, meminfo.data() + meminfo.size(), kilobytes);
  if (error != std::errc{} || kilobytes > (std::uint64_t{1} << 50U)) return std::nullopt;
  return kilobytes * 1024;
}

std::uint64_t memory_pressure_bytes(std::uint64_t resident_bytes,
                                    std::optional<std::uint64_t> available_bytes, std::uint64_t reserve_bytes,
                                    std::uint64_t threshold_bytes) {
  if (!available_bytes || *available_bytes >= reserve_bytes) return resident_bytes;
  return std::max(resident_bytes, threshold_bytes + (reserve_bytes - *available_bytes));
}

std::uint64_t measured_memory_pressure_bytes(std::uint64_t reserve_bytes, std::uint64_t threshold_bytes) {
  std::ifstream file("/proc/meminfo");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  return memory_pressure_bytes(metrics::process_usage().rss_bytes, parse_available_bytes(text), reserve_bytes,
                               threshold_bytes);
}

}  // namespace edgesplat::offload
