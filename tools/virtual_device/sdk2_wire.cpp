// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/sdk2_wire.hpp"

#include "common/base/bytes.hpp"

#include <zlib.h>

#include <cstring>

namespace edgesplat::virtual_device {
namespace {

constexpr std::size_t kFrameHeader = 24;
constexpr std::size_t kPacketHeader = 36;
constexpr std::size_t kStampAt = 28;

/// CRC-16/CCITT-FALSE, bit by bit.
std::uint16_t ccitt_false(std::span<const std::byte> bytes) {
  unsigned value = 0xFFFF;
  for (const std::byte byte : bytes) {
    value ^= std::to_integer<unsigned>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit)
      value = (value & 0x8000U) != 0 ? ((value << 1U) ^ 0x1021U) & 0xFFFFU : (value << 1U) & 0xFFFFU;
  }
  return static_cast<std::uint16_t>(value);
}

std::uint32_t zlib_crc(std::span<const std::byte> bytes) {
  if (bytes.empty()) return 0;  // zlib takes a null pointer as a call for the start value
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

template <typename T>
void put(std::span<std::byte> bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}
template <typename T>
T get(std::span<const std::byte> bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

}  // namespace

std::optional<Sdk2Request> parse_sdk2_request(std::span<const std::byte> datagram) {
  if (datagram.size() < kFrameHeader || datagram.size() > 1400) return std::nullopt;
  const bool good = get<std::uint8_t>(datagram, 0) == 0xAA && get<std::uint8_t>(datagram, 1) == 0 &&
                    get<std::uint16_t>(datagram, 2) == datagram.size() &&
                    get<std::uint16_t>(datagram, 18) == ccitt_false(datagram.first(18)) &&
                    get<std::uint32_t>(datagram, 20) == zlib_crc(datagram.subspan(kFrameHeader));
  const bool from_host = get<std::uint8_t>(datagram, 10) == 0 && get<std::uint8_t>(datagram, 11) == 0;
  if (!good || !from_host) return std::nullopt;
  return Sdk2Request{get<std::uint32_t>(datagram, 4), get<std::uint16_t>(datagram, 8),
                     datagram.subspan(kFrameHeader)};
}

std::vector<std::byte> make_sdk2_frame(std::uint32_t sequence, std::uint16_t command, Sdk2Kind kind,
                                       std::span<const std::byte> content) {
  ByteWriter frame;
  frame.write(std::uint8_t{0xAA});
  frame.write(std::uint8_t{0});
  frame.write(static_cast<std::uint16_t>(kFrameHeader + content.size()));
  frame.write(sequence);
  frame.write(command);
  frame.write(static_cast<std::uint8_t>(kind));
  frame.write(std::uint8_t{1});  // from the LiDAR
  for (int i = 0; i < 6; ++i) frame.write(std::uint8_t{0});
  frame.write(ccitt_false(frame.bytes()));
  frame.write(zlib_crc(content));
  frame.write_bytes(content);
  return frame.take();
}

bool restamp_sdk2(std::span<std::byte> packet, const Sdk2Stamp& stamp) {
  if (packet.size() < kPacketHeader) return false;
  put(packet, 7, stamp.udp_count);
  put(packet, 11, stamp.time_type);
  put(packet, kStampAt, stamp.stamp_ns);
  put(packet, 24, zlib_crc(packet.subspan(kStampAt)));
  return true;
}

std::optional<RecordedStamp> recorded_stamp(std::span<const std::byte> packet) {
  if (packet.size() < kPacketHeader) return std::nullopt;
  return RecordedStamp{get<std::int64_t>(packet, kStampAt), get<std::uint8_t>(packet, 11) != 0};
}

std::span<const std::byte> recorded_records(std::span<const std::byte> packet) {
  return packet.size() < kPacketHeader ? std::span<const std::byte>{} : packet.subspan(kPacketHeader);
}

}  // namespace edgesplat::virtual_device
