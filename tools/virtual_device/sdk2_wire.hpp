// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::virtual_device {

/// The device's side of the SDK2 frames (../shared/design/sensor-protocols.md 1.2, 1.6).
struct Sdk2Request {
  std::uint32_t sequence = 0;
  std::uint16_t command = 0;
  std::span<const std::byte> content;
};
/// A host's request; nothing where a check fails or it is none.
[[nodiscard]] std::optional<Sdk2Request> parse_sdk2_request(std::span<const std::byte> datagram);

enum class Sdk2Kind : std::uint8_t { kRequest = 0, kAck = 1 };
[[nodiscard]] std::vector<std::byte> make_sdk2_frame(std::uint32_t sequence, std::uint16_t command,
                                                     Sdk2Kind kind, std::span<const std::byte> content);

/// What a unit writes on a data packet.
struct Sdk2Stamp {
  std::int64_t stamp_ns = 0;
  std::uint8_t time_type = 0;
  std::uint16_t udp_count = 0;
};
/// Puts it on a recorded packet, with the checksum; false where it is too short to be one.
[[nodiscard]] bool restamp_sdk2(std::span<std::byte> packet, const Sdk2Stamp& stamp);
/// The stamp that is on a recorded packet and whether a master held the clock then.
struct RecordedStamp {
  std::int64_t stamp_ns = 0;
  bool was_held = false;
};
[[nodiscard]] std::optional<RecordedStamp> recorded_stamp(std::span<const std::byte> packet);
/// The records of a recorded packet.
[[nodiscard]] std::span<const std::byte> recorded_records(std::span<const std::byte> packet);

}  // namespace edgesplat::virtual_device
