// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/image.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::virtual_device {

/// GVSP, the stream channel of GigE Vision: a frame as a leader, payload packets and a trailer, big-endian.
/// Header: u16 status | u16 frame | u32 (content type << 24 | packet number). Source:
/// ../shared/design/sensor-protocols.md 3.1.
inline constexpr std::size_t kGvspHeaderBytes = 8;
inline constexpr std::size_t kIpUdpHeaderBytes = 28;  ///< part of GevSCPSPacketSize
inline constexpr std::uint32_t kMinPacketBytes = 256, kMaxPacketBytes = 9000;

/// Codes of the pixel format naming convention (EMVA PFNC).
enum class GigePixelFormat : std::uint32_t {
  kMono8 = 0x0108'0001,
  kBayerRg8 = 0x0108'0009,
  kRgb8 = 0x0218'0014,
};
[[nodiscard]] bool is_pixel_format(std::uint32_t code);
[[nodiscard]] std::size_t bytes_per_pixel(GigePixelFormat format);
/// The picture as the sensor sends it: luma, every second colour of a mosaic that begins with red, or all.
[[nodiscard]] std::vector<std::byte> encode_pixels(const sensor::ImageRgb8& image, GigePixelFormat format);

/// A frame in the camera's memory, from which packets are made at first sending and again on request.
struct GvspFrame {
  std::uint16_t number = 0;  ///< 1..65535, never 0
  std::uint64_t stamp_ticks = 0;
  GigePixelFormat format = GigePixelFormat::kMono8;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  bool has_chunks = false;
  std::vector<std::byte> payload;  ///< pixels, then chunks
};

/// Closes what was appended to `payload` since the last chunk (first the pixels) as chunk `id` of `bytes`.
void end_chunk(std::vector<std::byte>& payload, std::uint32_t id, std::uint32_t bytes);

enum class GvspStatus : std::uint16_t { kFirst = 0x0000, kResent = 0x0100, kUnavailable = 0x800C };

/// Leader, payload packets and trailer at this GevSCPSPacketSize (with IP and UDP headers).
[[nodiscard]] std::uint32_t gvsp_packet_count(std::size_t payload_bytes, std::uint32_t packet_bytes);
/// Packet `index` of a frame into `out`. Precondition: index < gvsp_packet_count().
void encode_gvsp_packet(const GvspFrame& frame, std::uint32_t index, std::uint32_t packet_bytes,
                        GvspStatus status, std::vector<std::byte>& out);
/// What a camera says about packets that it no longer has.
[[nodiscard]] std::vector<std::byte> gvsp_unavailable(std::uint16_t frame, std::uint32_t packet);

}  // namespace edgesplat::virtual_device
