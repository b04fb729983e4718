// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/gige_gvsp.hpp"

#include "common/base/check.hpp"
#include "tools/virtual_device/big_endian.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::virtual_device {
namespace {

constexpr std::uint32_t kLeader = 1, kTrailer = 2, kPayload = 3;
constexpr std::uint16_t kImageType = 0x0001, kImageWithChunksType = 0x4001;
constexpr std::size_t kHeaders = kIpUdpHeaderBytes + kGvspHeaderBytes;

void begin_packet(ByteWriter& out, GvspStatus status, std::uint16_t frame, std::uint32_t content,
                  std::uint32_t packet) {
  write_be16(out, static_cast<std::uint16_t>(status));
  write_be16(out, frame);
  write_be32(out, content << 24U | packet);
}

void write_leader(ByteWriter& out, const GvspFrame& frame) {
  write_be16(out, 0);
  write_be16(out, frame.has_chunks ? kImageWithChunksType : kImageType);
  write_be64(out, frame.stamp_ticks);
  write_be32(out, static_cast<std::uint32_t>(frame.format));
  write_be32(out, frame.width_px);
  write_be32(out, frame.height_px);
  for (int offset_or_padding = 0; offset_or_padding < 3; ++offset_or_padding) write_be32(out, 0);
}

void write_trailer(ByteWriter& out, const GvspFrame& frame) {
  write_be32(out, frame.has_chunks ? kImageWithChunksType : kImageType);
  write_be32(out, frame.height_px);
}

std::byte luma(const std::uint8_t* rgb) {  // BT.601, in 1/256
  return static_cast<std::byte>((77U * rgb[0] + 150U * rgb[1] + 29U * rgb[2] + 128U) >> 8U);
}

}  // namespace

bool is_pixel_format(std::uint32_t code) {
  return code == static_cast<std::uint32_t>(GigePixelFormat::kMono8) ||
         code == static_cast<std::uint32_t>(GigePixelFormat::kBayerRg8) ||
         code == static_cast<std::uint32_t>(GigePixelFormat::kRgb8);
}

std::size_t bytes_per_pixel(GigePixelFormat format) {
  return format == GigePixelFormat::kRgb8 ? 3 : 1;
}

std::vector<std::byte> encode_pixels(const sensor::ImageRgb8& image, GigePixelFormat format) {
  const auto values = std::as_bytes(std::span(image.values));
  if (format == GigePixelFormat::kRgb8) return {values.begin(), values.end()};
  std::vector<std::byte> out;
  out.reserve(values.size() / 3);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const std::uint8_t* rgb = image.pixel(x, y);
      const int channel = (x & 1) + (y & 1);  // red first, then green, blue on odd lines
      out.push_back(format == GigePixelFormat::kMono8 ? luma(rgb) : static_cast<std::byte>(rgb[channel]));
    }
  }
  return out;
}

void end_chunk(std::vector<std::byte>& payload, std::uint32_t id, std::uint32_t bytes) {
  ByteWriter tail;
  write_be32(tail, id);
  write_be32(tail, bytes);
  payload.insert(payload.end(), tail.bytes().begin(), tail.bytes().end());
}

std::uint32_t gvsp_packet_count(std::size_t payload_bytes, std::uint32_t packet_bytes) {
  const std::size_t room = packet_bytes - kHeaders;
  return static_cast<std::uint32_t>((payload_bytes + room - 1) / room) + 2;
}

void encode_gvsp_packet(const GvspFrame& frame, std::uint32_t index, std::uint32_t packet_bytes,
                        GvspStatus status, std::vector<std::byte>& out) {
  const std::uint32_t count = gvsp_packet_count(frame.payload.size(), packet_bytes);
  EDGESPLAT_CHECK(index < count, "a packet of the frame");
  ByteWriter packet;
  packet.reserve(packet_bytes);
  if (index == 0) {
    begin_packet(packet, status, frame.number, kLeader, index);
    write_leader(packet, frame);
  } else if (index == count - 1) {
    begin_packet(packet, status, frame.number, kTrailer, index);
    write_trailer(packet, frame);
  } else {
    const std::size_t room = packet_bytes - kHeaders;
    const std::size_t at = (index - 1) * room;
    begin_packet(packet, status, frame.number, kPayload, index);
    packet.write_bytes(std::span(frame.payload).subspan(at, std::min(room, frame.payload.size() - at)));
  }
  out = packet.take();
}

std::vector<std::byte> gvsp_unavailable(std::uint16_t frame, std::uint32_t packet) {
  ByteWriter out;
  begin_packet(out, GvspStatus::kUnavailable, frame, kPayload, packet);
  return out.take();
}

}  // namespace edgesplat::virtual_device
