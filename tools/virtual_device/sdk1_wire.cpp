// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/sdk1_wire.hpp"

#include <zlib.h>

#include <ctime>

namespace edgesplat::virtual_device {
namespace {

constexpr std::size_t kSmallest = 15;
constexpr std::size_t kContentAt = 11;
constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kHour_s = 3600;

/// CRC-16 with poly 0x1021 reflected and start 0x4C49, bit by bit.
std::uint16_t header_crc(std::span<const std::byte> bytes) {
  unsigned value = 0x4C49;
  for (const std::byte byte : bytes) {
    value ^= std::to_integer<unsigned>(byte);
    for (int bit = 0; bit < 8; ++bit) value = (value & 1U) != 0 ? (value >> 1U) ^ 0x8408U : value >> 1U;
  }
  return static_cast<std::uint16_t>(value);
}

std::uint32_t whole_crc(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      ::crc32(0x564F580AU, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

}  // namespace

std::optional<Sdk1Request> parse_sdk1_request(std::span<const std::byte> datagram) {
  if (datagram.size() < kSmallest || datagram.size() > 1400) return std::nullopt;
  ByteReader reader(datagram);
  const bool starts = reader.read<std::uint8_t>() == 0xAA && reader.read<std::uint8_t>() == 1;
  const bool whole = reader.read<std::uint16_t>() == datagram.size();
  const bool is_request = reader.read<std::uint8_t>() <= static_cast<std::uint8_t>(Sdk1Kind::kAck);
  Sdk1Request request;
  request.sequence = reader.read<std::uint16_t>();
  const bool header_good = reader.read<std::uint16_t>() == header_crc(datagram.first(7));
  const unsigned set = reader.read<std::uint8_t>();
  request.command = static_cast<std::uint16_t>((set << 8U) | reader.read<std::uint8_t>());
  request.content = reader.take(datagram.size() - kSmallest);
  const bool good = reader.read<std::uint32_t>() == whole_crc(datagram.first(datagram.size() - 4));
  if (!starts || !whole || !is_request || !header_good || !good) return std::nullopt;
  return request;
}

std::vector<std::byte> make_sdk1_frame(std::uint16_t sequence, std::uint16_t command, Sdk1Kind kind,
                                       std::span<const std::byte> content) {
  ByteWriter writer;
  writer.write(std::uint8_t{0xAA});
  writer.write(std::uint8_t{1});
  writer.write(static_cast<std::uint16_t>(kSmallest + content.size()));
  writer.write(static_cast<std::uint8_t>(kind));
  writer.write(sequence);
  writer.write(header_crc(writer.bytes()));
  writer.write(static_cast<std::uint8_t>(command >> 8U));
  writer.write(static_cast<std::uint8_t>(command & 0xFFU));
  writer.write_bytes(content);
  static_assert(kContentAt + sizeof(std::uint32_t) == kSmallest);
  writer.write(whole_crc(writer.bytes()));
  return writer.take();
}

std::optional<std::int64_t> read_sdk1_date(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  std::tm date{};
  date.tm_year = reader.read<std::uint8_t>() + 100;  // since 1900
  date.tm_mon = reader.read<std::uint8_t>() - 1;
  date.tm_mday = reader.read<std::uint8_t>();
  date.tm_hour = reader.read<std::uint8_t>();
  const std::int64_t microseconds = reader.read<std::uint32_t>();
  if (!reader.ok() || date.tm_mon < 0 || date.tm_mon > 11 || date.tm_mday < 1 || date.tm_mday > 31 ||
      date.tm_hour > 23 || microseconds >= kHour_s * 1'000'000)
    return std::nullopt;
  return ::timegm(&date) * kSecond_ns + microseconds * 1000;
}

void write_sdk1_date(ByteWriter& writer, std::int64_t unix_ns) {
  const std::time_t seconds = unix_ns / kSecond_ns;
  std::tm date{};
  (void)::gmtime_r(&seconds, &date);
  writer.write(static_cast<std::uint8_t>(date.tm_year - 100));
  writer.write(static_cast<std::uint8_t>(date.tm_mon + 1));
  writer.write(static_cast<std::uint8_t>(date.tm_mday));
  writer.write(static_cast<std::uint8_t>(date.tm_hour));
  const std::int64_t in_hour_ns = (seconds % kHour_s) * kSecond_ns + unix_ns % kSecond_ns;
  writer.write(static_cast<std::uint32_t>(in_hour_ns / 1000));
}

}  // namespace edgesplat::virtual_device
