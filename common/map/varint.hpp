// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"

#include <cstdint>

namespace edgesplat::map {

/// LEB128: seven bits a byte, the lowest first; at most ten bytes.
inline void write_varint(ByteWriter& out, std::uint64_t value) {
  while (value >= 0x80U) {
    out.write(static_cast<std::uint8_t>(value | 0x80U));
    value >>= 7U;
  }
  out.write(static_cast<std::uint8_t>(value));
}

/// 0 and, past the end or over ten bytes, `in` not ok.
[[nodiscard]] inline std::uint64_t read_varint(ByteReader& in) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const auto part = in.read<std::uint8_t>();
    value |= static_cast<std::uint64_t>(part & 0x7FU) << shift;
    if ((part & 0x80U) == 0) return value;
  }
  in.skip(in.remaining() + 1);
  return 0;
}

/// Small differences of either sign as small numbers: 0, -1, 1, -2 ... become 0, 1, 2, 3 ...
[[nodiscard]] constexpr std::uint64_t zigzag(std::uint64_t difference) {
  return (difference << 1U) ^ (0 - (difference >> 63U));
}
[[nodiscard]] constexpr std::uint64_t unzigzag(std::uint64_t value) {
  return (value >> 1U) ^ (0 - (value & 1U));
}

}  // namespace edgesplat::map
