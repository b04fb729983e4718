// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"
#include "robot/drivers/livox/checksum.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::livox {

/// A frame as an SDK1 LiDAR would send it.
inline std::vector<std::byte> sdk1_frame(std::uint16_t command, std::uint8_t type,
                                         std::span<const std::byte> content, std::uint16_t sequence = 42) {
  ByteWriter writer;
  writer.write(std::uint8_t{0xAA});
  writer.write(std::uint8_t{1});
  writer.write(static_cast<std::uint16_t>(15 + content.size()));
  writer.write(type);
  writer.write(sequence);
  writer.write(sdk1_crc16(writer.bytes()));
  writer.write(static_cast<std::uint8_t>(command >> 8U));
  writer.write(static_cast<std::uint8_t>(command & 0xFFU));
  writer.write_bytes(content);
  writer.write(sdk1_crc32(writer.bytes()));
  return writer.take();
}

/// Header of an SDK1 data packet.
inline std::vector<std::byte> sdk1_packet(std::uint8_t type, std::uint8_t time_type,
                                          std::span<const std::byte> eight_bytes_of_time,
                                          std::span<const std::byte> records) {
  ByteWriter writer;
  writer.write(std::uint8_t{5});
  writer.write(std::uint8_t{0});
  writer.write(std::uint8_t{1});
  writer.write(std::uint8_t{0});
  writer.write(std::uint32_t{0x00004200});  // pulse seen, synchronised by PTP
  writer.write(time_type);
  writer.write(type);
  writer.write_bytes(eight_bytes_of_time);
  writer.write_bytes(records);
  return writer.take();
}

inline std::vector<std::byte> sdk1_packet(std::uint8_t type, std::uint8_t time_type, std::uint64_t stamp_ns,
                                          std::span<const std::byte> records) {
  ByteWriter writer;
  writer.write(stamp_ns);
  return sdk1_packet(type, time_type, writer.bytes(), records);
}

}  // namespace edgesplat::livox
