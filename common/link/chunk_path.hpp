// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/lane.hpp"
#include "common/link/train.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

namespace edgesplat::link {

enum class WriteOutcome : std::uint8_t {
  kWritten,
  kBusy,     ///< the network takes nothing now; the same chunk may be tried again
  kRefused,  ///< for good
};
using ChunkHandler = std::function<void(const ChunkHeader&, std::span<const std::byte>)>;

/// What carries single chunks between the two ends: DDS, a queue inside one process, or either of them made
/// worse on purpose (ImpairedPath). Belongs to one thread, the one that runs LinkEnd::step().
class ChunkPath {
 public:
  virtual ~ChunkPath() = default;
  /// Waits at most 20 ms for the network.
  virtual WriteOutcome write(Lane lane, const ChunkHeader& header, std::span<const std::byte> payload) = 0;
  /// Takes one chunk that came, if there is one. False: nothing was there.
  virtual bool take(Lane lane, const ChunkHandler& handle) = 0;
  /// Somebody receives what is written to the lane.
  [[nodiscard]] virtual bool has_reader(Lane lane) const = 0;

  /// Moves on what the path itself holds back until `now`.
  virtual void pump(HostTime /*now*/) {}
  /// When pump() has something to do next; nothing where the path holds nothing back.
  [[nodiscard]] virtual std::optional<HostTime> next_event() const { return std::nullopt; }
};

}  // namespace edgesplat::link
