// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"

#include <cstdint>

namespace edgesplat::virtual_device {

/// Fields of the wire in network order (GigE Vision), on the little-endian readers and writers of
/// common/base.
inline std::uint16_t read_be16(ByteReader& reader) {
  return __builtin_bswap16(reader.read<std::uint16_t>());
}
inline std::uint32_t read_be32(ByteReader& reader) {
  return __builtin_bswap32(reader.read<std::uint32_t>());
}
inline std::uint64_t read_be64(ByteReader& reader) {
  return __builtin_bswap64(reader.read<std::uint64_t>());
}
inline void write_be16(ByteWriter& writer, std::uint16_t value) {
  writer.write(__builtin_bswap16(value));
}
inline void write_be32(ByteWriter& writer, std::uint32_t value) {
  writer.write(__builtin_bswap32(value));
}
inline void write_be64(ByteWriter& writer, std::uint64_t value) {
  writer.write(__builtin_bswap64(value));
}

}  // namespace edgesplat::virtual_device
