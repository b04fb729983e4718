// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/ids.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::link {

/// Where the robot's work is done at present (Algorithm 1).
enum class OffloadMode : std::uint8_t { kLocal = 0, kLean = 1, kFull = 2 };

/// Sent by both ends every 200 ms; what an end does not know is 0.
struct Heartbeat {
  map::Epoch epoch;
  std::uint64_t seq = 0;       ///< server: last delta made; robot: last delta applied
  std::uint64_t map_hash = 0;  ///< over its own memory, after `seq`
  OffloadMode mode = OffloadMode::kFull;
  std::uint32_t queued_messages = 0;
  std::uint64_t queued_bytes = 0;
  float render_p95_ms = 0.0F;
  std::uint64_t memory_bytes = 0;
  float goodput_bytes_per_s = 0.0F;
};

[[nodiscard]] std::vector<std::byte> encode_heartbeat(const Heartbeat& heartbeat);
/// kCorrupt for a wrong magic, version, length, mode or a number that is not finite.
[[nodiscard]] Result<Heartbeat> decode_heartbeat(std::span<const std::byte> bytes);

}  // namespace edgesplat::link
