// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/livox_command.hpp"

#include "common/base/bytes.hpp"
#include "common/base/check.hpp"
#include "robot/drivers/livox/checksum.hpp"

#include <algorithm>

namespace edgesplat::livox {
namespace {

constexpr std::uint8_t kStartByte = 0xAA;
constexpr std::size_t kLengthAt = 2;
constexpr std::size_t kHeaderCrcAt = 18;
constexpr std::size_t kContentCrcAt = 20;

/// A request from the host; finish() fills in length and checksums.
class RequestWriter {
 public:
  RequestWriter(CommandId id, std::uint32_t sequence) {
    writer_.write(kStartByte);
    writer_.write(std::uint8_t{0});   // version
    writer_.write(std::uint16_t{0});  // length
    writer_.write(sequence);
    writer_.write(static_cast<std::uint16_t>(id));
    writer_.write(std::uint8_t{0});  // request
    writer_.write(std::uint8_t{0});  // from the host
    for (int i = 0; i < 6; ++i) writer_.write(std::uint8_t{0});
    writer_.write(std::uint16_t{0});  // crc16
    writer_.write(std::uint32_t{0});  // crc32
  }
  ByteWriter& content() { return writer_; }
  std::vector<std::byte> finish() {
    EDGESPLAT_CHECK(writer_.size() <= kMaxCommandBytes, "a command frame holds at most 1400 bytes");
    writer_.patch(kLengthAt, static_cast<std::uint16_t>(writer_.size()));
    writer_.patch(kHeaderCrcAt, crc16(writer_.bytes().first(kHeaderCrcAt)));
    writer_.patch(kContentCrcAt, crc32(writer_.bytes().subspan(kCommandHeaderBytes)));
    return writer_.take();
  }

 private:
  ByteWriter writer_;
};

void begin_list(ByteWriter& writer, std::uint16_t count) {
  writer.write(count);
  writer.write(std::uint16_t{0});
}

std::vector<std::byte> encode_set_byte(std::uint32_t sequence, Key key, std::uint8_t value) {
  const std::array<std::uint8_t, 1> bytes{value};
  const KeyValue parameter{key, std::as_bytes(std::span(bytes))};
  return encode_set_parameters(sequence, std::span(&parameter, 1));
}

/// `count` entries {key, length, value}; memory grows with the bytes that are there, not with `count`.
Result<std::vector<KeyValue>> read_list(ByteReader& reader, std::uint16_t count) {
  std::vector<KeyValue> entries;
  for (std::uint16_t i = 0; i < count; ++i) {
    const auto key = static_cast<Key>(reader.read<std::uint16_t>());
    const auto value = reader.take(reader.read<std::uint16_t>());
    if (!reader.ok())
      return fail(Errc::kBadPacket, "Livox parameter list ends inside entry " + std::to_string(i + 1) +
                                        " of " + std::to_string(count));
    entries.push_back({key, value});
  }
  return entries;
}

}  // namespace

std::vector<std::byte> encode_discovery(std::uint32_t sequence) {
  return RequestWriter(CommandId::kDiscovery, sequence).finish();
}

std::array<std::byte, 8> encode_host(const HostAddress& host) {
  ByteWriter writer;
  writer.write_bytes(std::as_bytes(std::span(host.ip)));
  writer.write(host.host_port);
  writer.write(host.lidar_port);
  std::array<std::byte, 8> value{};
  std::copy(writer.bytes().begin(), writer.bytes().end(), value.begin());
  return value;
}

std::vector<std::byte> encode_set_parameters(std::uint32_t sequence, std::span<const KeyValue> parameters) {
  RequestWriter request(CommandId::kSetParameters, sequence);
  begin_list(request.content(), static_cast<std::uint16_t>(parameters.size()));
  for (const auto& [key, value] : parameters) {
    request.content().write(static_cast<std::uint16_t>(key));
    request.content().write(static_cast<std::uint16_t>(value.size()));
    request.content().write_bytes(value);
  }
  return request.finish();
}

std::vector<std::byte> encode_set_hosts(std::uint32_t sequence, const HostAddress& state,
                                        const HostAddress& points, const HostAddress& imu) {
  const auto state_value = encode_host(state);
  const auto points_value = encode_host(points);
  const auto imu_value = encode_host(imu);
  const std::array<KeyValue, 3> parameters{KeyValue{Key::kStateHost, state_value},
                                           KeyValue{Key::kPointHost, points_value},
                                           KeyValue{Key::kImuHost, imu_value}};
  return encode_set_parameters(sequence, parameters);
}

std::vector<std::byte> encode_set_work_mode(std::uint32_t sequence, WorkMode mode) {
  return encode_set_byte(sequence, Key::kWorkMode, static_cast<std::uint8_t>(mode));
}

std::vector<std::byte> encode_set_point_type(std::uint32_t sequence, std::uint8_t type) {
  return encode_set_byte(sequence, Key::kPointDataType, type);
}

std::vector<std::byte> encode_set_imu(std::uint32_t sequence, bool enabled) {
  return encode_set_byte(sequence, Key::kImuEnabled, enabled ? std::uint8_t{1} : std::uint8_t{0});
}

std::vector<std::byte> encode_reboot(std::uint32_t sequence, std::uint16_t delay_ms) {
  RequestWriter request(CommandId::kReboot, sequence);
  request.content().write(delay_ms);
  return request.finish();
}

std::vector<std::byte> encode_set_gps_time(std::uint32_t sequence, std::uint64_t edge_ns) {
  RequestWriter request(CommandId::kSetGpsTime, sequence);
  request.content().write(std::uint8_t{2});
  request.content().write(edge_ns);
  return request.finish();
}

std::vector<std::byte> encode_query(std::uint32_t sequence, std::span<const Key> keys) {
  RequestWriter request(CommandId::kQueryParameters, sequence);
  begin_list(request.content(), static_cast<std::uint16_t>(keys.size()));
  for (const Key key : keys) request.content().write(static_cast<std::uint16_t>(key));
  return request.finish();
}

Result<CommandFrame> decode_command(std::span<const std::byte> datagram) {
  if (datagram.size() < kCommandHeaderBytes || datagram.size() > kMaxCommandBytes)
    return fail(Errc::kBadPacket, "Livox command frame of " + std::to_string(datagram.size()) +
                                      " bytes; 24 to 1400 are possible");
  ByteReader reader(datagram);
  const bool start_ok = reader.read<std::uint8_t>() == kStartByte;
  const bool version_ok = reader.read<std::uint8_t>() == 0;
  if (!start_ok || !version_ok)
    return fail(Errc::kBadPacket, "no Livox SDK2 command frame: it must start with AA 00");
  const auto length = reader.read<std::uint16_t>();
  if (length != datagram.size())
    return fail(Errc::kBadPacket, "Livox command frame says " + std::to_string(length) + " bytes but has " +
                                      std::to_string(datagram.size()));
  CommandFrame frame;
  frame.sequence = reader.read<std::uint32_t>();
  frame.id = static_cast<CommandId>(reader.read<std::uint16_t>());
  const auto command_type = reader.read<std::uint8_t>();
  const auto sender = reader.read<std::uint8_t>();
  reader.skip(6);
  if (reader.read<std::uint16_t>() != crc16(datagram.first(kHeaderCrcAt)))
    return fail(Errc::kBadPacket, "Livox command frame: wrong header checksum (crc16)");
  if (command_type > 1 || sender > 1)
    return fail(Errc::kBadPacket, "Livox command frame: neither request nor acknowledgement");
  frame.is_ack = command_type == 1;
  frame.from_lidar = sender == 1;
  const auto content_crc = reader.read<std::uint32_t>();
  frame.content = datagram.subspan(kCommandHeaderBytes);
  // The protocol says 0 where there is no content, which is also the checksum of nothing.
  if (content_crc != crc32(frame.content))
    return fail(Errc::kBadPacket, "Livox command frame: wrong content checksum (crc32)");
  return frame;
}

Result<DiscoveredLidar> decode_discovery_ack(const CommandFrame& frame) {
  if (frame.id != CommandId::kDiscovery || !frame.is_ack)
    return fail(Errc::kBadPacket, "Livox frame is no answer to a discovery");
  ByteReader reader(frame.content);
  const auto return_code = reader.read<std::uint8_t>();
  DiscoveredLidar lidar;
  lidar.device_type = reader.read<std::uint8_t>();
  const auto serial = reader.take(kSerialNumberBytes);
  for (std::uint8_t& part : lidar.ip) part = reader.read<std::uint8_t>();
  lidar.command_port = reader.read<std::uint16_t>();
  if (!reader.ok()) return fail(Errc::kBadPacket, "Livox discovery answer is shorter than 24 bytes");
  if (return_code != 0)
    return fail(Errc::kUnavailable,
                "Livox LiDAR refused the discovery: " + std::string(describe_return_code(return_code)));
  lidar.serial_number = read_serial_number(serial);
  return lidar;
}

std::string read_serial_number(std::span<const std::byte> bytes) {
  std::string serial_number;
  for (const std::byte byte : bytes) {
    const char letter = std::to_integer<char>(byte);
    if (letter < ' ' || letter > '~') break;
    serial_number.push_back(letter);
  }
  return serial_number;
}

Result<ParameterReply> decode_parameter_reply(const CommandFrame& frame) {
  const bool is_set = frame.id == CommandId::kSetParameters;
  if (!frame.is_ack || (!is_set && frame.id != CommandId::kQueryParameters))
    return fail(Errc::kBadPacket, "Livox frame is no answer to a set or query");
  ByteReader reader(frame.content);
  ParameterReply reply;
  reply.return_code = reader.read<std::uint8_t>();
  const auto key_or_count = reader.read<std::uint16_t>();
  if (!reader.ok()) return fail(Errc::kBadPacket, "Livox parameter answer is shorter than 3 bytes");
  if (is_set) {
    reply.error_key = key_or_count;
    return reply;
  }
  EDGESPLAT_TRY(reply.parameters, read_list(reader, key_or_count));
  return reply;
}

Result<std::vector<KeyValue>> decode_state_push(const CommandFrame& frame) {
  if (frame.id != CommandId::kStatePush) return fail(Errc::kBadPacket, "Livox frame is no state push");
  ByteReader reader(frame.content);
  const auto count = reader.read<std::uint16_t>();
  reader.skip(2);
  if (!reader.ok()) return fail(Errc::kBadPacket, "Livox state push is shorter than 4 bytes");
  return read_list(reader, count);
}

std::string_view describe_return_code(std::uint8_t code) {
  switch (code) {
    case 0x00:
      return "done";
    case 0x01:
      return "failed";
    case 0x02:
      return "not permitted in this work state";
    case 0x03:
      return "value out of range";
    case 0x20:
      return "parameter not supported";
    case 0x21:
      return "stored, takes effect after a reboot";
    case 0x22:
      return "parameter is read-only";
    case 0x23:
      return "wrong value length";
    case 0x24:
      return "number of keys does not match the list";
    default:
      return "unknown return code";
  }
}

}  // namespace edgesplat::livox
