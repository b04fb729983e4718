// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

namespace edgesplat::offload {

/// MemAvailable of the text of /proc/meminfo.
[[nodiscard]] std::optional<std::uint64_t> parse_available_bytes(std::string_view meminfo);

/// What counts as memory for the decision: this process's resident bytes; where the machine has less than
/// `reserve` left, at least `threshold` and what is missing from the reserve, whoever took it.
[[nodiscard]] std::uint64_t memory_pressure_bytes(std::uint64_t resident_bytes,
                                                  std::optional<std::uint64_t> available_bytes,
                                                  std::uint64_t reserve_bytes, std::uint64_t threshold_bytes);

/// The same, measured now (/proc/self/status, /proc/meminfo). The robot's GPU shares this memory.
[[nodiscard]] std::uint64_t measured_memory_pressure_bytes(std::uint64_t reserve_bytes,
                                                           std::uint64_t threshold_bytes);

}  // namespace edgesplat::offload
