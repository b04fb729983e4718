// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::livox {

/// Fields of a data packet as a test wants them, right or wrong.
struct PacketFields {
  std::uint8_t version = 0;
  std::uint16_t interval = 4750;  ///< 0.1 us
  std::uint16_t dots = 1;
  std::uint16_t udp_count = 0;
  std::uint8_t frame_count = 0;
  std::uint8_t type = 1;
  std::uint8_t time_type = 1;
  std::uint64_t stamp_ns = 1'700'000'000'000'000'000U;
  std::vector<std::byte> records;
};

/// A datagram with right length and checksum, whatever the fields say.
inline std::vector<std::byte> packet_bytes(const PacketFields& fields) {
  ByteWriter writer;
  writer.write(fields.version);
  writer.write(static_cast<std::uint16_t>(36 + fields.records.size()));
  writer.write(fields.interval);
  writer.write(fields.dots);
  writer.write(fields.udp_count);
  writer.write(fields.frame_count);
  writer.write(fields.type);
  writer.write(fields.time_type);
  for (int i = 0; i < 12; ++i) writer.write(std::uint8_t{0});
  writer.write(std::uint32_t{0});
  writer.write(fields.stamp_ns);
  writer.write_bytes(fields.records);
  const auto checked = writer.bytes().subspan(28);
  writer.patch(24, static_cast<std::uint32_t>(::crc32(0, reinterpret_cast<const Bytef*>(checked.data()),
                                                      static_cast<uInt>(checked.size()))));
  return writer.take();
}

/// One point record of type 1.
inline void append_point_mm(std::vector<std::byte>& records, std::int32_t x, std::int32_t y, std::int32_t z,
                            std::uint8_t reflectivity = 77, std::uint8_t tag = 0) {
  ByteWriter writer;
  writer.write(x);
  writer.write(y);
  writer.write(z);
  writer.write(reflectivity);
  writer.write(tag);
  records.insert(records.end(), writer.bytes().begin(), writer.bytes().end());
}

/// One IMU record.
inline std::vector<std::byte> imu_record(std::span<const float> six) {
  ByteWriter writer;
  for (const float value : six) writer.write(value);
  return writer.take();
}

}  // namespace edgesplat::livox
