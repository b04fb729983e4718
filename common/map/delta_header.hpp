// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"
#include "common/base/result.hpp"
#include "common/map/delta.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace edgesplat::map {

inline constexpr std::uint32_t kDeltaMagic = 0x31445345U;  ///< "ESD1"
inline constexpr std::uint16_t kDeltaVersion = 3;
inline constexpr std::size_t kDeltaHeader_bytes = 57;
inline constexpr std::size_t kMaxDelta_bytes = std::size_t{20} << 20U;

/// Header and body as one message; header.length_bytes is taken from the body.
[[nodiscard]] std::vector<std::byte> seal_delta(DeltaHeader header, std::span<const std::byte> body);

/// Header of any delta after checking magic, version, kind, length and CRC32C: what is left is to understand
/// the body. kCorrupt with the reason otherwise.
[[nodiscard]] Result<DeltaHeader> decode_delta_header(std::span<const std::byte> bytes);

}  // namespace edgesplat::map
