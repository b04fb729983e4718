// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace edgesplat::livox {

/// CRC-16/CCITT-FALSE (poly 0x1021, init 0xFFFF, not reflected): "123456789" -> 0x29B1.
[[nodiscard]] std::uint16_t crc16(std::span<const std::byte> bytes);
/// CRC-32 of zlib: "123456789" -> 0xCBF43926; of nothing 0.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes);

}  // namespace edgesplat::livox
