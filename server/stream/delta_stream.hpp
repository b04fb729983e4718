// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/delta.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::stream {

/// Numbers and encodes what one robot has to be told about its map: each delta builds on the one before.
/// Single-owner.
class DeltaStream {
 public:
  /// `max_rows`: Gaussians in one delta, 1..65536; a larger change becomes several.
  DeltaStream(map::RobotId robot, const map::MapUuid& map, map::Epoch epoch, std::size_t max_rows)
      : robot_(robot), map_(map), epoch_(epoch), max_rows_(max_rows) {}

  /// New Gaussians as encoded ADDs, none for no rows. Errors as of encode_add; no number is used up then.
  Result<std::vector<std::vector<std::byte>>> add(const gaussian::GaussianCloud& gaussians,
                                                  std::span<const map::ChunkId> chunks);
  /// Of the last delta made; 0 before the first.
  [[nodiscard]] std::uint64_t seq() const { return seq_; }
  [[nodiscard]] map::Epoch epoch() const { return epoch_; }

 private:
  map::RobotId robot_;
  map::MapUuid map_;
  map::Epoch epoch_;
  std::size_t max_rows_;
  std::uint64_t seq_ = 0;
};

}  // namespace edgesplat::stream
