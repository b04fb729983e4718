// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/measurement.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace edgesplat::frame_socket {

/// The camera's TCP protocol: messages of a 48-byte header and a compressed picture, all little-endian.
///
/// | offset | field | | offset | field |
/// |---|---|---|---|---|
/// | 0 | magic 'ESFC' | | 28 | f32 gain_db |
/// | 4 | u16 version = 1 | | 32 | u8 stamp source: 0 free, 1 PTP, 2 GPS |
/// | 6 | u16 header_bytes = 48 | | 33 | u8 format: 1 JPEG, 2 PNG |
/// | 8 | u32 payload_bytes | | 34 | u16 reserved |
/// | 12 | u32 sequence | | 36, 38 | u16 width, u16 height |
/// | 16 | i64 stamp_ns, middle of the exposure | | 40 | u32 CRC-32 (zlib) of the payload |
/// | 24 | f32 exposure_s | | 44 | u32 CRC-32 of the 44 bytes before |
inline constexpr std::size_t kHeaderBytes = 48;
inline constexpr std::array<std::byte, 4> kMagic{std::byte{0x45}, std::byte{0x53}, std::byte{0x46},
                                                 std::byte{0x43}};
inline constexpr std::uint32_t kMaxPayloadBytes = std::uint32_t{32} << 20U;

enum class PictureFormat : std::uint8_t { kJpeg = 1, kPng = 2 };

struct FrameHeader {
  std::uint32_t payload_bytes = 0;
  std::uint32_t sequence = 0;
  SensorTime stamp{};  ///< middle of the exposure
  float exposure_s = 0.0F;
  float gain_db = 0.0F;
  sensor::StampSource stamp_source = sensor::StampSource::kFreeRunning;
  PictureFormat format = PictureFormat::kJpeg;
  std::uint16_t width_px = 0;
  std::uint16_t height_px = 0;
  std::uint32_t payload_crc32 = 0;
};

/// Checks magic, version, sizes, ranges and the header's checksum. kBadPacket says which failed.
/// Precondition: header.size() >= kHeaderBytes.
[[nodiscard]] Result<FrameHeader> decode_header(std::span<const std::byte> header);
/// CRC-32 of zlib.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes);

}  // namespace edgesplat::frame_socket
