// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

namespace edgesplat::virtual_device {

/// GVCP, the control channel of GigE Vision: commands to a camera on UDP port 3956 and its answers,
/// big-endian. Header: u8 type (0x42 command, 0x00 ack, 0x80 error) | u8 flags | u16 command | u16 payload
/// bytes | u16 id. Source: ../shared/design/sensor-protocols.md 3.1. The device's side, written apart from
/// libaravis.
inline constexpr std::uint16_t kGvcpPort = 3956;
inline constexpr std::size_t kGvcpMaxPayloadBytes = 540;  ///< 4 bytes address + 536 data

struct GvcpDiscovery {};
struct GvcpReadRegister {
  std::vector<std::uint32_t> addresses;  ///< 1..135
};
struct GvcpWriteRegister {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> writes;  ///< address, value
};
struct GvcpReadMemory {
  std::uint32_t address = 0;
  std::uint16_t count_bytes = 0;  ///< 1..536
};
struct GvcpWriteMemory {
  std::uint32_t address = 0;
  std::span<const std::byte> data;  ///< borrowed from the datagram
};
/// Packets first..last of a frame; the camera answers on the stream channel, not here.
struct GvcpPacketResend {
  std::uint64_t frame = 0;
  std::uint32_t first_packet = 0;
  std::uint32_t last_packet = 0;
};

struct GvcpCommand {
  std::uint16_t id = 0;
  bool wants_answer = false;
  std::variant<GvcpDiscovery, GvcpReadRegister, GvcpWriteRegister, GvcpReadMemory, GvcpWriteMemory,
               GvcpPacketResend>
      what;
};

enum class GvcpStatus : std::uint16_t {
  kNotImplemented = 0x8001,
  kInvalidParameter = 0x8002,
  kInvalidAddress = 0x8003,
  kWriteProtect = 0x8004,
  kBadAlignment = 0x8005,
  kAccessDenied = 0x8006,
};

/// What is wrong with bytes that are no command. `answer` is the error to send back, where the sender expects
/// one.
struct GvcpFault {
  std::optional<std::vector<std::byte>> answer;
};
using GvcpDecoded = std::variant<GvcpCommand, GvcpFault>;

/// Decodes one datagram; whatever the bytes are, it reads none beyond them.
[[nodiscard]] GvcpDecoded decode_gvcp(std::span<const std::byte> datagram);

[[nodiscard]] std::vector<std::byte> gvcp_discovery_ack(std::uint16_t id,
                                                        std::span<const std::byte> bootstrap);
[[nodiscard]] std::vector<std::byte> gvcp_read_register_ack(std::uint16_t id,
                                                            std::span<const std::uint32_t> values);
/// `done`: how many of the registers were written.
[[nodiscard]] std::vector<std::byte> gvcp_write_register_ack(std::uint16_t id, std::uint16_t done);
[[nodiscard]] std::vector<std::byte> gvcp_read_memory_ack(std::uint16_t id, std::uint32_t address,
                                                          std::span<const std::byte> data);
[[nodiscard]] std::vector<std::byte> gvcp_write_memory_ack(std::uint16_t id, std::uint16_t count_bytes);
/// The error answer to `command`.
[[nodiscard]] std::vector<std::byte> gvcp_error(const GvcpCommand& command, GvcpStatus status);

}  // namespace edgesplat::virtual_device
