// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "common/time/time.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace edgesplat::virtual_device {

inline constexpr std::size_t kFrameHeaderBytes = 48;

enum class FrameFormat : std::uint8_t { kJpeg = 1, kPng = 2 };

/// One compressed picture on its way from a camera to the robot over TCP.
struct FrameMessage {
  std::uint32_t sequence = 0;
  SensorTime stamp{};  ///< middle of the exposure, device time
  float exposure_s = 0.0F;
  float gain_db = 0.0F;
  sensor::StampSource stamp_source = sensor::StampSource::kFreeRunning;
  FrameFormat format = FrameFormat::kJpeg;
  std::uint16_t width_px = 0;
  std::uint16_t height_px = 0;
};

/// The header that goes before the payload, all fields little-endian:
///   0 'ESFC' | 4 u16 version 1 | 6 u16 header bytes 48 | 8 u32 payload bytes | 12 u32 sequence | 16 i64
///   stamp ns 24 f32 exposure s | 28 f32 gain dB | 32 u8 stamp source (0 free 1 ptp 2 gps) | 33 u8 format (1
///   jpeg 2 png) 34 u16 reserved | 36 u16 width | 38 u16 height | 40 u32 payload crc32 | 44 u32 crc32 of
///   bytes 0..43
/// Both sums are zlib's CRC-32. The payload is smaller than 4 GiB.
[[nodiscard]] std::array<std::byte, kFrameHeaderBytes> encode_frame_header(
    const FrameMessage& message, std::span<const std::byte> payload);

}  // namespace edgesplat::virtual_device
