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
#include <vector>

namespace edgesplat::livox {

/// Command frames of the SDK1 protocol (Avia, Horizon, Mid-40/70, Tele-15; sensor-protocols sheet, 2.2 to
/// 2.4). The LiDAR announces itself on UDP 55000, the host talks to its port 65000. Set and id in one number:
/// 0x0104 is id 4 of set 1.
enum class Sdk1Command : std::uint16_t {
  kAnnouncement = 0x0000,  ///< LiDAR to host: who I am
  kHandshake = 0x0001,
  kDeviceInfo = 0x0002,
  kHeartbeat = 0x0003,
  kSampling = 0x0004,
  kCoordinate = 0x0005,
  kDisconnect = 0x0006,
  kStatusPush = 0x0007,  ///< LiDAR to host: something is wrong
  kReboot = 0x000A,
  kReturnMode = 0x0106,
  kImuRate = 0x0108,
  kUtcSync = 0x010A,
};

enum class Sdk1FrameType : std::uint8_t { kRequest = 0, kAck = 1, kMessage = 2 };

enum class ReturnMode : std::uint8_t { kFirst = 0, kStrongest = 1, kDual = 2, kTriple = 3 };

inline constexpr std::size_t kSdk1FrameBytes = 15;  ///< of a frame without content

/// A checked frame; `content` borrows from the datagram.
struct Sdk1Frame {
  Sdk1FrameType type = Sdk1FrameType::kRequest;
  std::uint16_t sequence = 0;  ///< an acknowledgement repeats that of its request
  Sdk1Command command = Sdk1Command::kAnnouncement;
  std::span<const std::byte> content;
};

/// Where an SDK1 LiDAR shall send.
struct Sdk1Host {
  Ipv4 ip{};
  std::uint16_t data_port = 0;
  std::uint16_t command_port = 0;
  std::uint16_t imu_port = 0;
};

/// Who announces itself.
struct Sdk1Announcement {
  std::string serial_number;     ///< the broadcast code: the serial number and one character
  std::uint8_t device_type = 0;  ///< 7 Avia
};

/// The status word of heartbeats, pushes and data packets.
struct Sdk1Status {
  bool pulse_seen = false;  ///< pulse per second
  bool ptp_seen = false;
  std::uint8_t time_sync = 0;    ///< 0 none, 1 PTP, 2 GPS, 3 pulse only, 4 abnormal
  std::uint8_t system = 0;       ///< 0 normal, 1 warning, 2 error
  std::uint8_t temperature = 0;  ///< of each: 0 normal, 1 warning, 2 error
  std::uint8_t voltage = 0;
  std::uint8_t motor = 0;
  std::uint8_t dirty_window = 0;
};

/// Answer to a heartbeat.
struct Sdk1Heartbeat {
  std::uint8_t return_code = 0;
  std::uint8_t work_state = 0;           ///< 0 starting, 1 normal, 2 saving power, 3 standby, 4 error
  std::uint32_t status_or_progress = 0;  ///< status word; while starting: percent
};

[[nodiscard]] std::vector<std::byte> encode_sdk1_handshake(std::uint16_t sequence, const Sdk1Host& host);
/// A request without content: device info, heartbeat, disconnect.
[[nodiscard]] std::vector<std::byte> encode_sdk1_request(std::uint16_t sequence, Sdk1Command command);
/// A request with one byte: sampling (1 start, 0 stop), coordinate (0 Cartesian), IMU rate (1 = 200 Hz),
/// return mode.
[[nodiscard]] std::vector<std::byte> encode_sdk1_request(std::uint16_t sequence, Sdk1Command command,
                                                         std::uint8_t value);
/// Time of the last rising edge of the pulse-per-second line, ns since 1970; years 2000 to 2255.
[[nodiscard]] std::vector<std::byte> encode_sdk1_utc(std::uint16_t sequence, std::int64_t edge_ns);

/// Checks start byte, version, length and both checksums. kBadPacket says which of them failed.
[[nodiscard]] Result<Sdk1Frame> decode_sdk1(std::span<const std::byte> datagram);
[[nodiscard]] Result<Sdk1Announcement> decode_sdk1_announcement(const Sdk1Frame& frame);
[[nodiscard]] Result<Sdk1Heartbeat> decode_sdk1_heartbeat(const Sdk1Frame& frame);
/// First byte of every acknowledgement: 0 done. kBadPacket where it is none.
[[nodiscard]] Result<std::uint8_t> decode_sdk1_return_code(const Sdk1Frame& frame);
/// Of a device info acknowledgement: the firmware's four numbers.
[[nodiscard]] Result<std::array<std::uint8_t, 4>> decode_sdk1_firmware(const Sdk1Frame& frame);
/// Of a status push: the status word.
[[nodiscard]] Result<std::uint32_t> decode_sdk1_status_push(const Sdk1Frame& frame);
[[nodiscard]] Sdk1Status read_sdk1_status(std::uint32_t word);

}  // namespace edgesplat::livox
