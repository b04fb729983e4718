// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/checksum.hpp"

#include <zlib.h>

#include <array>

namespace edgesplat::livox {
namespace {

constexpr std::array<std::uint16_t, 256> crc16_table() {
  std::array<std::uint16_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t value = i << 8U;
    for (int bit = 0; bit < 8; ++bit) value = (value << 1U) ^ ((value & 0x8000U) != 0 ? 0x1021U : 0U);
    table[i] = static_cast<std::uint16_t>(value & 0xFFFFU);
  }
  return table;
}
constexpr auto kCrc16Table = crc16_table();

/// Bits run the other way round in SDK1's frames: poly 0x1021 reflected.
constexpr std::array<std::uint16_t, 256> reflected_crc16_table() {
  std::array<std::uint16_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1U) ^ ((value & 1U) != 0 ? 0x8408U : 0U);
    table[i] = static_cast<std::uint16_t>(value);
  }
  return table;
}
constexpr auto kReflectedCrc16Table = reflected_crc16_table();

}  // namespace

std::uint16_t crc16(std::span<const std::byte> bytes) {
  std::uint32_t value = 0xFFFFU;
  for (const std::byte byte : bytes) {
    const std::uint32_t index = ((value >> 8U) ^ std::to_integer<std::uint32_t>(byte)) & 0xFFU;
    value = ((value << 8U) ^ kCrc16Table[index]) & 0xFFFFU;
  }
  return static_cast<std::uint16_t>(value);
}

std::uint32_t crc32(std::span<const std::byte> bytes) {
  const auto* first = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(::crc32_z(::crc32_z(0, nullptr, 0), first, bytes.size()));
}

std::uint16_t sdk1_crc16(std::span<const std::byte> bytes) {
  std::uint32_t value = 0x4C49U;
  for (const std::byte byte : bytes)
    value = (value >> 8U) ^ kReflectedCrc16Table[(value ^ std::to_integer<std::uint32_t>(byte)) & 0xFFU];
  return static_cast<std::uint16_t>(value);
}

std::uint32_t sdk1_crc32(std::span<const std::byte> bytes) {
  constexpr uLong kSeed = 0x564F580AU;
  const auto* first = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(::crc32_z(kSeed, first, bytes.size()));
}

}  // namespace edgesplat::livox
