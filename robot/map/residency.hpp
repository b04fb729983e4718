// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/map_request.hpp"
#include "common/map/map_state.hpp"
#include "common/time/time.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace edgesplat::map {

/// Which chunks fit into the robot's memory: those nearest to it. Over 9/10 of the budget the server is asked
/// to drop the farthest, so that both ends do it at the same delta; over the whole budget they are dropped
/// here at once. Chunks given up are remembered and asked for again when the robot nears them and there is
/// room. Pure; single-owner.
class Residency {
 public:
  explicit Residency(std::size_t budget_bytes) : budget_bytes_(budget_bytes) {}

  void robot_at(const Eigen::Vector3f& p_in_map_m) { robot_in_map_m_ = p_in_map_m; }
  [[nodiscard]] const Eigen::Vector3f& robot_in_map_m() const { return robot_in_map_m_; }
  /// A delta was applied: what the server dropped or sent as a whole.
  void applied(const Delta& delta);
  /// The farthest chunks to drop now so that `state` keeps the budget, if it does not.
  [[nodiscard]] std::vector<ChunkId> overflow(const MapState& state, std::size_t bytes_each) const;
  /// overflow() was heeded for one chunk.
  void dropped_alone(const ChunkId& chunk, std::size_t gaussians);
  /// What to ask the server for; at most one request a kind and second. Chunks only.
  std::vector<MapRequest> requests(const MapState& state, std::size_t bytes_each, HostTime now);

  /// No chunk was dropped here that the server still counts as held: hashes can be compared.
  [[nodiscard]] bool in_step() const { return alone_.empty(); }
  /// Memory is left for chunks of a snapshot.
  [[nodiscard]] bool has_room(const MapState& state, std::size_t bytes_each) const;
  [[nodiscard]] std::size_t absent_chunks() const { return absent_.size() + alone_.size(); }

 private:
  using Ranked = std::vector<std::pair<float, std::pair<ChunkId, std::size_t>>>;  ///< distance, chunk, count
  [[nodiscard]] Ranked farthest_first(const MapState& state) const;
  [[nodiscard]] float distance_m(const ChunkId& chunk) const;
  [[nodiscard]] std::vector<ChunkId> to_fetch(const MapState& state, std::size_t bytes_each) const;

  std::size_t budget_bytes_;
  Eigen::Vector3f robot_in_map_m_ = Eigen::Vector3f::Zero();
  std::map<ChunkId, std::size_t> absent_;  ///< the server knows; with the Gaussians each had
  std::map<ChunkId, std::size_t> alone_;   ///< dropped here, the server does not know yet
  std::map<ChunkId, std::size_t> asked_;   ///< to drop, with the Gaussians each had then
  std::optional<HostTime> release_asked_;
  std::optional<HostTime> fetch_asked_;
};

}  // namespace edgesplat::map
