// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace edgesplat::livox {

/// SDK2: CRC-16/CCITT-FALSE (poly 0x1021, init 0xFFFF, not reflected): "123456789" -> 0x29B1.
[[nodiscard]] std::uint16_t crc16(std::span<const std::byte> bytes);
/// SDK2: CRC-32 of zlib: "123456789" -> 0xCBF43926; of nothing 0.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes);
/// SDK1: poly 0x1021 reflected, start 0x4C49: "123456789" -> 0xAB4E.
[[nodiscard]] std::uint16_t sdk1_crc16(std::span<const std::byte> bytes);
/// SDK1: zlib's CRC-32 carried on from 0x564F580A: "123456789" -> 0xB08DB5B1.
[[nodiscard]] std::uint32_t sdk1_crc32(std::span<const std::byte> bytes);

}  // namespace edgesplat::livox
