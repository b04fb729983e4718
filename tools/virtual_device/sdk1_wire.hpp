// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/bytes.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::virtual_device {

/// The device's side of the SDK1 frames (../shared/design/sensor-protocols.md 2.2).
struct Sdk1Request {
  std::uint16_t sequence = 0;
  std::uint16_t command = 0;  ///< set and id
  std::span<const std::byte> content;
};
/// A host's request (or an acknowledgement, as which some hosts send their handshake); nothing where a check
/// fails.
[[nodiscard]] std::optional<Sdk1Request> parse_sdk1_request(std::span<const std::byte> datagram);

enum class Sdk1Kind : std::uint8_t { kRequest = 0, kAck = 1, kMessage = 2 };
[[nodiscard]] std::vector<std::byte> make_sdk1_frame(std::uint16_t sequence, std::uint16_t command,
                                                     Sdk1Kind kind, std::span<const std::byte> content);

/// Eight bytes: year - 2000, month, day, hour, us within the hour. Nothing where the date does not exist.
[[nodiscard]] std::optional<std::int64_t> read_sdk1_date(std::span<const std::byte> bytes);
void write_sdk1_date(ByteWriter& writer, std::int64_t unix_ns);

}  // namespace edgesplat::virtual_device
