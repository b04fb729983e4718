// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/map/delta.hpp"
#include "common/map/id_index.hpp"
#include "common/map/map_hash.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

namespace edgesplat::map {

/// The Gaussians that a robot holds, as integers: the robot keeps one, and the server one for each robot, of
/// what it was sent. Equal deltas in equal order make equal states on every machine, so that each side's hash
/// is over its own memory. Knows nothing of order, gaps or budgets. Single-owner.
class MapState {
 public:
  /// Does what a checked delta says; one with base_seq 0 begins with an empty map. kCorrupt, and nothing
  /// changes, for another SH degree than that of the Gaussians held.
  [[nodiscard]] Status apply(const Delta& delta);
  void clear();
  /// Forgets a chunk's Gaussians; returns how many.
  std::size_t drop_chunk(const ChunkId& chunk);

  [[nodiscard]] std::optional<std::uint32_t> find(gaussian::GaussianId id) const { return index_.find(id); }
  [[nodiscard]] const QuantisedRows& rows() const { return rows_; }
  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  /// Over every record and its chunk.
  [[nodiscard]] std::uint64_t hash() const { return hash_.value(); }
  [[nodiscard]] const MapHash& chunks() const { return hash_; }
  /// Level of detail that a chunk is held at.
  [[nodiscard]] std::uint8_t level(const ChunkId& chunk) const;
  [[nodiscard]] const std::optional<MaskBody>& newest_mask() const { return mask_; }
  /// Memory of the Gaussians and their index.
  [[nodiscard]] std::size_t bytes() const;
  /// Memory of one Gaussian, its share of the index included.
  [[nodiscard]] std::size_t bytes_each() const;

 private:
  void apply_body(const AddBody& body);
  void apply_body(const UpdateBody& body);
  void apply_body(const RemoveBody& body);
  void apply_body(const ChunkReplaceBody& body);
  void apply_body(const ReposeBody& body);
  void apply_body(const MaskBody& body);
  void apply_body(const MappedBody& /*body*/) {}  // of no concern to what is held
  [[nodiscard]] std::uint64_t digest(std::size_t row) const;
  void put(const QuantisedRows& from, std::size_t row);
  void remove_row(std::size_t row);

  QuantisedRows rows_;
  IdIndex index_;
  MapHash hash_;
  std::map<ChunkId, std::uint8_t> levels_;  ///< those above 0
  std::optional<MaskBody> mask_;
};

}  // namespace edgesplat::map
