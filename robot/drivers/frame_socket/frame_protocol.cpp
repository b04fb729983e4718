// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/frame_socket/frame_protocol.hpp"

#include "common/base/bytes.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace edgesplat::frame_socket {
namespace {

constexpr std::size_t kHeaderCrcAt = 44;
constexpr std::int64_t kLatest_ns = std::int64_t{1} << 62U;  // sums and differences of stamps stay in range

}  // namespace

std::uint32_t crc32(std::span<const std::byte> bytes) {
  const auto* first = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(::crc32_z(::crc32_z(0, nullptr, 0), first, bytes.size()));
}

Result<FrameHeader> decode_header(std::span<const std::byte> header) {
  ByteReader reader(header);
  const auto magic = reader.take(kMagic.size());
  if (!std::equal(magic.begin(), magic.end(), kMagic.begin(), kMagic.end()))
    return fail(Errc::kBadPacket, "camera message does not start with 'ESFC'");
  const auto version = reader.read<std::uint16_t>();
  const auto header_bytes = reader.read<std::uint16_t>();
  FrameHeader out;
  out.payload_bytes = reader.read<std::uint32_t>();
  out.sequence = reader.read<std::uint32_t>();
  const auto stamp_ns = reader.read<std::int64_t>();
  out.exposure_s = reader.read<float>();
  out.gain_db = reader.read<float>();
  const auto stamp_source = reader.read<std::uint8_t>();
  const auto format = reader.read<std::uint8_t>();
  reader.skip(2);
  out.width_px = reader.read<std::uint16_t>();
  out.height_px = reader.read<std::uint16_t>();
  out.payload_crc32 = reader.read<std::uint32_t>();
  const auto header_crc32 = reader.read<std::uint32_t>();
  if (!reader.ok() || header_crc32 != crc32(header.first(kHeaderCrcAt)))
    return fail(Errc::kBadPacket, "camera message: wrong header checksum");
  if (version != 1 || header_bytes != kHeaderBytes)
    return fail(Errc::kBadPacket, "camera message of version " + std::to_string(version) +
                                      " with a header of " + std::to_string(header_bytes) +
                                      " bytes; this driver reads version 1 with 48 bytes");
  if (out.payload_bytes == 0 || out.payload_bytes > kMaxPayloadBytes)
    return fail(Errc::kBadPacket, "camera message announces " + std::to_string(out.payload_bytes) +
                                      " bytes of picture; 1 to " + std::to_string(kMaxPayloadBytes) +
                                      " are accepted");
  const bool known =
      stamp_source <= 2 && (format == 1 || format == 2) && out.width_px > 0 && out.height_px > 0;
  const bool finite = std::isfinite(out.exposure_s) && std::isfinite(out.gain_db) && out.exposure_s >= 0.0F;
  if (!known || !finite || stamp_ns <= -kLatest_ns || stamp_ns >= kLatest_ns)
    return fail(Errc::kBadPacket, "camera message: a field is out of its range");
  out.stamp = sensor_time_from_ns(stamp_ns);
  out.stamp_source = static_cast<sensor::StampSource>(stamp_source);
  out.format = static_cast<PictureFormat>(format);
  return out;
}

}  // namespace edgesplat::frame_socket
