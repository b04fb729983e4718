// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/measurement.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace edgesplat::replay {

inline constexpr std::uintmax_t kScanPointBytes = 16;  ///< float32 x, y, z (m), intensity
inline constexpr std::uintmax_t kMaxScanFileBytes = std::uintmax_t{256} << 20U;

/// Points of one KITTI `.bin` scan. Points that are not finite or are (0, 0, 0) are left out and added to
/// `dropped`; intensity is clamped to 0..1. kCorrupt where the size is not a multiple of 16 bytes.
[[nodiscard]] Result<std::vector<sensor::LidarPoint>> parse_scan(std::span<const std::byte> bytes,
                                                                 std::string_view file_name,
                                                                 std::uint64_t& dropped);
/// kCorrupt for a size that is not a multiple of 16 bytes, zero or beyond kMaxScanFileBytes.
[[nodiscard]] Status check_scan_size(std::uintmax_t bytes, std::string_view file_name);

}  // namespace edgesplat::replay
