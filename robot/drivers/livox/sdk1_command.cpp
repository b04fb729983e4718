// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/sdk1_command.hpp"

#include "common/base/bytes.hpp"
#include "common/base/check.hpp"
#include "robot/drivers/livox/checksum.hpp"
#include "robot/drivers/livox/livox_command.hpp"
#include "robot/drivers/livox/utc_date.hpp"

namespace edgesplat::livox {
namespace {

constexpr std::uint8_t kStartByte = 0xAA;
constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kLengthAt = 2;
constexpr std::size_t kHeaderCrcAt = 7;
constexpr std::size_t kContentAt = 11;
constexpr std::size_t kCrc32Bytes = 4;

/// A request from the host; finish() fills in length and checksums.
class RequestWriter {
 public:
  RequestWriter(Sdk1Command command, std::uint16_t sequence) {
    const auto number = static_cast<std::uint16_t>(command);
    writer_.write(kStartByte);
    writer_.write(kVersion);
    writer_.write(std::uint16_t{0});  // length
    // The vendor's library marks its handshake as an acknowledgement; LiDARs take it as a request as well.
    writer_.write(static_cast<std::uint8_t>(Sdk1FrameType::kRequest));
    writer_.write(sequence);
    writer_.write(std::uint16_t{0});  // crc16
    writer_.write(static_cast<std::uint8_t>(number >> 8U));
    writer_.write(static_cast<std::uint8_t>(number & 0xFFU));
  }
  ByteWriter& content() { return writer_; }
  std::vector<std::byte> finish() {
    writer_.patch(kLengthAt, static_cast<std::uint16_t>(writer_.size() + kCrc32Bytes));
    writer_.patch(kHeaderCrcAt, sdk1_crc16(writer_.bytes().first(kHeaderCrcAt)));
    writer_.write(sdk1_crc32(writer_.bytes()));
    return writer_.take();
  }

 private:
  ByteWriter writer_;
};

/// `count` bits of the status word from bit `first`.
std::uint8_t bits(std::uint32_t word, unsigned first, unsigned count) {
  return static_cast<std::uint8_t>((word >> first) & ((1U << count) - 1U));
}

Status expect(const Sdk1Frame& frame, Sdk1Command command, Sdk1FrameType type, const char* what) {
  if (frame.command == command && frame.type == type) return {};
  return fail(Errc::kBadPacket, std::string("Livox SDK1 frame is no ") + what);
}

}  // namespace

std::vector<std::byte> encode_sdk1_handshake(std::uint16_t sequence, const Sdk1Host& host) {
  RequestWriter request(Sdk1Command::kHandshake, sequence);
  request.content().write_bytes(std::as_bytes(std::span(host.ip)));
  request.content().write(host.data_port);
  request.content().write(host.command_port);
  request.content().write(host.imu_port);
  return request.finish();
}

std::vector<std::byte> encode_sdk1_request(std::uint16_t sequence, Sdk1Command command) {
  return RequestWriter(command, sequence).finish();
}

std::vector<std::byte> encode_sdk1_request(std::uint16_t sequence, Sdk1Command command, std::uint8_t value) {
  RequestWriter request(command, sequence);
  request.content().write(value);
  return request.finish();
}

std::vector<std::byte> encode_sdk1_utc(std::uint16_t sequence, std::int64_t edge_ns) {
  const UtcDate date = to_utc_date(edge_ns);
  EDGESPLAT_CHECK(date.year >= 2000 && date.year <= 2255, "the protocol counts years from 2000 in one byte");
  RequestWriter request(Sdk1Command::kUtcSync, sequence);
  request.content().write(static_cast<std::uint8_t>(date.year - 2000));
  request.content().write(static_cast<std::uint8_t>(date.month));
  request.content().write(static_cast<std::uint8_t>(date.day));
  request.content().write(static_cast<std::uint8_t>(date.hour));
  request.content().write(date.microsecond_of_hour);
  return request.finish();
}

Result<Sdk1Frame> decode_sdk1(std::span<const std::byte> datagram) {
  if (datagram.size() < kSdk1FrameBytes || datagram.size() > kMaxCommandBytes)
    return fail(Errc::kBadPacket,
                "Livox SDK1 frame of " + std::to_string(datagram.size()) + " bytes; 15 to 1400 are possible");
  ByteReader reader(datagram);
  const bool start_ok = reader.read<std::uint8_t>() == kStartByte;
  const bool version_ok = reader.read<std::uint8_t>() == kVersion;
  if (!start_ok || !version_ok)
    return fail(Errc::kBadPacket, "no Livox SDK1 frame: it must start with AA 01");
  const auto length = reader.read<std::uint16_t>();
  if (length != datagram.size())
    return fail(Errc::kBadPacket, "Livox SDK1 frame says " + std::to_string(length) + " bytes but has " +
                                      std::to_string(datagram.size()));
  const auto type = reader.read<std::uint8_t>();
  Sdk1Frame frame;
  frame.sequence = reader.read<std::uint16_t>();
  if (reader.read<std::uint16_t>() != sdk1_crc16(datagram.first(kHeaderCrcAt)))
    return fail(Errc::kBadPacket, "Livox SDK1 frame: wrong header checksum (crc16)");
  if (type > static_cast<std::uint8_t>(Sdk1FrameType::kMessage))
    return fail(Errc::kBadPacket, "Livox SDK1 frame: neither request, acknowledgement nor message");
  frame.type = static_cast<Sdk1FrameType>(type);
  const unsigned set = reader.read<std::uint8_t>();
  const unsigned id = reader.read<std::uint8_t>();
  frame.command = static_cast<Sdk1Command>((set << 8U) | id);
  frame.content = reader.take(datagram.size() - kContentAt - kCrc32Bytes);
  if (reader.read<std::uint32_t>() != sdk1_crc32(datagram.first(datagram.size() - kCrc32Bytes)))
    return fail(Errc::kBadPacket, "Livox SDK1 frame: wrong checksum (crc32)");
  return frame;
}

Result<Sdk1Announcement> decode_sdk1_announcement(const Sdk1Frame& frame) {
  EDGESPLAT_TRY_STATUS(expect(frame, Sdk1Command::kAnnouncement, Sdk1FrameType::kMessage, "announcement"));
  ByteReader reader(frame.content);
  Sdk1Announcement announcement;
  announcement.serial_number = read_serial_number(reader.take(kSerialNumberBytes));
  announcement.device_type = reader.read<std::uint8_t>();
  reader.skip(2);
  if (!reader.ok()) return fail(Errc::kBadPacket, "Livox SDK1 announcement is shorter than 19 bytes");
  return announcement;
}

Result<Sdk1Heartbeat> decode_sdk1_heartbeat(const Sdk1Frame& frame) {
  EDGESPLAT_TRY_STATUS(expect(frame, Sdk1Command::kHeartbeat, Sdk1FrameType::kAck, "answer to a heartbeat"));
  ByteReader reader(frame.content);
  Sdk1Heartbeat heartbeat;
  heartbeat.return_code = reader.read<std::uint8_t>();
  heartbeat.work_state = reader.read<std::uint8_t>();
  reader.skip(1);  // feature bits
  heartbeat.status_or_progress = reader.read<std::uint32_t>();
  if (!reader.ok()) return fail(Errc::kBadPacket, "Livox SDK1 answer to a heartbeat is shorter than 7 bytes");
  return heartbeat;
}

Result<std::uint8_t> decode_sdk1_return_code(const Sdk1Frame& frame) {
  if (frame.type != Sdk1FrameType::kAck || frame.content.empty())
    return fail(Errc::kBadPacket, "Livox SDK1 frame is no acknowledgement with a return code");
  return std::to_integer<std::uint8_t>(frame.content.front());
}

Result<std::array<std::uint8_t, 4>> decode_sdk1_firmware(const Sdk1Frame& frame) {
  EDGESPLAT_TRY_STATUS(
      expect(frame, Sdk1Command::kDeviceInfo, Sdk1FrameType::kAck, "answer with device information"));
  ByteReader reader(frame.content);
  reader.skip(1);  // return code
  std::array<std::uint8_t, 4> firmware{};
  for (std::uint8_t& number : firmware) number = reader.read<std::uint8_t>();
  if (!reader.ok()) return fail(Errc::kBadPacket, "Livox SDK1 device information is shorter than 5 bytes");
  return firmware;
}

Result<std::uint32_t> decode_sdk1_status_push(const Sdk1Frame& frame) {
  EDGESPLAT_TRY_STATUS(expect(frame, Sdk1Command::kStatusPush, Sdk1FrameType::kMessage, "status push"));
  ByteReader reader(frame.content);
  const auto word = reader.read<std::uint32_t>();
  if (!reader.ok()) return fail(Errc::kBadPacket, "Livox SDK1 status push is shorter than 4 bytes");
  return word;
}

Sdk1Status read_sdk1_status(std::uint32_t word) {
  Sdk1Status status;
  status.temperature = bits(word, 0, 2);
  status.voltage = bits(word, 2, 2);
  status.motor = bits(word, 4, 2);
  status.dirty_window = bits(word, 6, 2);
  status.pulse_seen = bits(word, 9, 1) != 0;
  status.ptp_seen = bits(word, 13, 1) != 0;
  status.time_sync = bits(word, 14, 3);
  status.system = bits(word, 30, 2);
  return status;
}

}  // namespace edgesplat::livox
