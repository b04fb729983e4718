// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/frame_message.hpp"

#include "common/base/bytes.hpp"
#include "common/base/check.hpp"

#include <zlib.h>

#include <algorithm>

namespace edgesplat::virtual_device {
namespace {

std::uint32_t zlib_sum(std::span<const std::byte> bytes) {
  const auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return static_cast<std::uint32_t>(sum);
}

}  // namespace

std::array<std::byte, kFrameHeaderBytes> encode_frame_header(const FrameMessage& message,
                                                             std::span<const std::byte> payload) {
  ByteWriter header;
  header.write_text("ESFC");
  header.write<std::uint16_t>(1);
  header.write(static_cast<std::uint16_t>(kFrameHeaderBytes));
  header.write(static_cast<std::uint32_t>(payload.size()));
  header.write(message.sequence);
  header.write(to_ns(message.stamp));
  header.write(message.exposure_s);
  header.write(message.gain_db);
  header.write(static_cast<std::uint8_t>(message.stamp_source));
  header.write(static_cast<std::uint8_t>(message.format));
  header.write<std::uint16_t>(0);
  header.write(message.width_px);
  header.write(message.height_px);
  header.write(zlib_sum(payload));
  header.write(zlib_sum(header.bytes()));
  EDGESPLAT_CHECK(header.size() == kFrameHeaderBytes, "the header's layout is fixed");
  std::array<std::byte, kFrameHeaderBytes> out{};
  std::ranges::copy(header.bytes(), out.begin());
  return out;
}

}  // namespace edgesplat::virtual_device
