// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace edgesplat::core {

/// Vector instructions that the CPU backend is compiled for, least first. On ARM only kBaseline (NEON).
enum class SimdLevel : std::uint8_t { kBaseline, kAvx2, kAvx512 };
[[nodiscard]] std::string_view to_string(SimdLevel level);

/// What this processor has, least first.
[[nodiscard]] std::vector<SimdLevel> available_simd_levels();
/// What the CPU backend uses now: the last of the available ones, or what limit_simd_level() said.
[[nodiscard]] SimdLevel simd_level();
/// Uses no more than `most` from now on: for tests and measurements. Not thread-safe with running kernels.
void limit_simd_level(SimdLevel most);

}  // namespace edgesplat::core
