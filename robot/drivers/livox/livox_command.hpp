// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "robot/drivers/livox/endpoint.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::livox {

/// Command frames of the SDK2 protocol (sensor-protocols sheet, 1.2 to 1.4). Host to LiDAR on port 56100,
/// discovery broadcast to 56000, state pushes on 56201.
enum class CommandId : std::uint16_t {
  kDiscovery = 0x0000,
  kSetParameters = 0x0100,
  kQueryParameters = 0x0101,
  kStatePush = 0x0102,
  kReboot = 0x0200,
  kSetGpsTime = 0x0202,
};

/// Keys of the parameter list that this driver uses.
enum class Key : std::uint16_t {
  kPointDataType = 0x0000,
  kStateHost = 0x0005,
  kPointHost = 0x0006,
  kImuHost = 0x0007,
  kWorkMode = 0x001A,
  kImuEnabled = 0x001C,
  kSerialNumber = 0x8000,
  kWorkState = 0x8006,
  kCoreTemperature = 0x8007,
  kTimeOffset = 0x800B,
  kSyncType = 0x800C,
  kFirmwareType = 0x8010,
  kFaultCodes = 0x8011,
};

enum class WorkMode : std::uint8_t { kSampling = 1, kIdle = 2, kReady = 9 };

inline constexpr std::size_t kCommandHeaderBytes = 24;
inline constexpr std::size_t kMaxCommandBytes = 1400;
inline constexpr std::size_t kSerialNumberBytes = 16;

/// A checked frame; `content` borrows from the datagram.
struct CommandFrame {
  std::uint32_t sequence = 0;  ///< an acknowledgement repeats that of its request
  CommandId id = CommandId::kDiscovery;
  bool is_ack = false;
  bool from_lidar = false;
  std::span<const std::byte> content;
};

/// One entry of a parameter list; `value` borrows, of a decoded one from the datagram.
struct KeyValue {
  Key key{};
  std::span<const std::byte> value;
};

/// Where the LiDAR shall send one channel, and from which of its ports.
struct HostAddress {
  Ipv4 ip{};
  std::uint16_t host_port = 0;
  std::uint16_t lidar_port = 0;

  bool operator==(const HostAddress&) const = default;
};

/// Who answered a discovery.
struct DiscoveredLidar {
  std::uint8_t device_type = 0;  ///< 9 Mid-360, 15 HAP
  std::string serial_number;
  Ipv4 ip{};
  std::uint16_t command_port = 0;
};

/// Answer to set or query.
struct ParameterReply {
  std::uint8_t return_code =
      0;  ///< 0 done, 0x21 done after a reboot, else refused; see describe_return_code()
  std::uint16_t error_key = 0;       ///< of a set
  std::vector<KeyValue> parameters;  ///< of a query
};

[[nodiscard]] std::vector<std::byte> encode_discovery(std::uint32_t sequence);
/// Tells the LiDAR where to send states, points and IMU (keys 5, 6, 7).
[[nodiscard]] std::vector<std::byte> encode_set_hosts(std::uint32_t sequence, const HostAddress& state,
                                                      const HostAddress& points, const HostAddress& imu);
/// Any parameters in one request. Precondition: together they fit into one frame.
[[nodiscard]] std::vector<std::byte> encode_set_parameters(std::uint32_t sequence,
                                                           std::span<const KeyValue> parameters);
[[nodiscard]] std::vector<std::byte> encode_set_work_mode(std::uint32_t sequence, WorkMode mode);
/// 1: int32 mm, 2: int16 cm, 3: spherical.
[[nodiscard]] std::vector<std::byte> encode_set_point_type(std::uint32_t sequence, std::uint8_t type);
[[nodiscard]] std::vector<std::byte> encode_set_imu(std::uint32_t sequence, bool enabled);
/// Time of the last rising edge of the pulse-per-second line, ns since 1970.
[[nodiscard]] std::vector<std::byte> encode_set_gps_time(std::uint32_t sequence, std::uint64_t edge_ns);
/// The LiDAR starts anew after `delay_ms`.
[[nodiscard]] std::vector<std::byte> encode_reboot(std::uint32_t sequence, std::uint16_t delay_ms);
/// Precondition: at most 600 keys (one frame).
[[nodiscard]] std::vector<std::byte> encode_query(std::uint32_t sequence, std::span<const Key> keys);

/// Checks start byte, version, length and both checksums. kBadPacket says which of them failed.
[[nodiscard]] Result<CommandFrame> decode_command(std::span<const std::byte> datagram);
/// Content of a discovery acknowledgement.
[[nodiscard]] Result<DiscoveredLidar> decode_discovery_ack(const CommandFrame& frame);
/// Content of a set or query acknowledgement, by frame.id.
[[nodiscard]] Result<ParameterReply> decode_parameter_reply(const CommandFrame& frame);
/// Content of a state push.
[[nodiscard]] Result<std::vector<KeyValue>> decode_state_push(const CommandFrame& frame);
/// The value of kStateHost, kPointHost or kImuHost, 8 bytes.
[[nodiscard]] std::array<std::byte, 8> encode_host(const HostAddress& host);
/// Zero-padded ASCII, cut at the first byte that is no printable character.
[[nodiscard]] std::string read_serial_number(std::span<const std::byte> bytes);
/// What a return code means, for the operator.
[[nodiscard]] std::string_view describe_return_code(std::uint8_t code);

}  // namespace edgesplat::livox
