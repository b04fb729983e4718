// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace edgesplat::map {

inline constexpr float kChunkEdge_m = 10.0F;
/// A Gaussian keeps the chunk it was born in until its mean is this far outside.
inline constexpr float kChunkSlack_m = 1.0F;
/// Largest coordinate of a mean that belongs to the map; codecs and seeding refuse what lies beyond.
inline constexpr float kMapLimit_m = 1.0e6F;

/// One cube of the map, 10 m a side: [10 x, 10 (x + 1)) and so on, in the map frame.
struct ChunkId {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;
  auto operator<=>(const ChunkId&) const = default;
};

/// True where a chunk can hold means within kMapLimit_m.
[[nodiscard]] bool chunk_in_map(const ChunkId& chunk);
/// The cube a point lies in. The point must be finite and within kMapLimit_m.
[[nodiscard]] ChunkId chunk_of(const Eigen::Vector3f& p_in_map_m);
/// Where a Gaussian of chunk `current` belongs after its mean moved: `current` up to kChunkSlack_m outside.
[[nodiscard]] ChunkId chunk_after_move(const ChunkId& current, const Eigen::Vector3f& p_in_map_m);

}  // namespace edgesplat::map

template <>
struct std::hash<edgesplat::map::ChunkId> {
  std::size_t operator()(const edgesplat::map::ChunkId& id) const noexcept {
    // Large odd primes (Teschner et al. 2003); neighbouring chunks get far apart.
    return static_cast<std::size_t>(static_cast<std::uint32_t>(id.x)) * 73856093U ^
           static_cast<std::size_t>(static_cast<std::uint32_t>(id.y)) * 19349663U ^
           static_cast<std::size_t>(static_cast<std::uint32_t>(id.z)) * 83492791U;
  }
};
