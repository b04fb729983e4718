// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::frame_socket {

/// Fields of a camera message as a test wants them, right or wrong.
struct MessageFields {
  std::uint16_t version = 1;
  std::uint16_t header_bytes = 48;
  std::int64_t payload_bytes = -1;  ///< -1: what the payload has
  std::uint32_t sequence = 0;
  std::int64_t stamp_ns = 1'000'000'000;
  float exposure_s = 0.005F;
  float gain_db = 3.0F;
  std::uint8_t stamp_source = 1;
  std::uint8_t format = 2;
  std::uint16_t width = 4;
  std::uint16_t height = 3;
};

inline std::uint32_t zlib_crc(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

/// A message with right checksums, whatever the fields say.
inline std::vector<std::byte> message_bytes(const MessageFields& fields, std::span<const std::byte> payload) {
  ByteWriter writer;
  writer.write_text("ESFC");
  writer.write(fields.version);
  writer.write(fields.header_bytes);
  writer.write(fields.payload_bytes < 0 ? static_cast<std::uint32_t>(payload.size())
                                        : static_cast<std::uint32_t>(fields.payload_bytes));
  writer.write(fields.sequence);
  writer.write(fields.stamp_ns);
  writer.write(fields.exposure_s);
  writer.write(fields.gain_db);
  writer.write(fields.stamp_source);
  writer.write(fields.format);
  writer.write(std::uint16_t{0});
  writer.write(fields.width);
  writer.write(fields.height);
  writer.write(zlib_crc(payload));
  writer.write(zlib_crc(writer.bytes()));
  writer.write_bytes(payload);
  return writer.take();
}

}  // namespace edgesplat::frame_socket
