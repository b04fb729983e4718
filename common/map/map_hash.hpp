// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/quantised.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace edgesplat::map {

/// 64-bit digest of one Gaussian as it travelled: id, every channel, SH and the anchor.
[[nodiscard]] std::uint64_t record_digest(const QuantisedRows& rows, std::size_t row);

/// Hash of a set of Gaussians, by chunk, that robot and server each keep over their own memory. Equal for
/// equal sets whatever the order in which the rows came or lie, as if the records were sorted by id: a
/// chunk's value is the sum of its records' digests, so that a change costs its own records only.
/// Single-owner.
class MapHash {
 public:
  void add(const ChunkId& chunk, std::uint64_t record_digest);
  void remove(const ChunkId& chunk, std::uint64_t record_digest);
  void clear() { chunks_.clear(); }
  /// Over all chunks in the order of their ids, empty ones left out; the empty map has a hash too.
  [[nodiscard]] std::uint64_t value() const;
  /// Of one chunk; 0 where it holds nothing.
  [[nodiscard]] std::uint64_t chunk_value(const ChunkId& chunk) const;
  [[nodiscard]] std::size_t chunk_count() const { return chunks_.size(); }
  /// Every chunk that holds something, with the number of its records, in the order of their ids.
  [[nodiscard]] std::vector<std::pair<ChunkId, std::size_t>> counts() const;

 private:
  struct Sum {
    std::uint64_t count = 0;
    std::uint64_t digests = 0;
  };
  std::map<ChunkId, Sum> chunks_;
};

}  // namespace edgesplat::map
