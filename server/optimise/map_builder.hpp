// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/chunk_id.hpp"
#include "common/map/keyframe.hpp"
#include "common/map/map_hash.hpp"
#include "kernels/mapping/seed.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::optimise {

/// What a keyframe changed: new rows and the chunk each is born in.
struct MapChange {
  gaussian::GaussianCloud added;
  std::vector<map::ChunkId> chunks;  ///< [N]
};

/// The server's map of one robot's session, grown keyframe by keyframe. `map` and `odom` are one frame until
/// poses are corrected. Single-owner.
class MapBuilder {
 public:
  /// `ids` must outlive this.
  MapBuilder(const mapping::SeedOptions& options, mapping::IdAllocator& ids) : seeder_(options, ids) {}

  MapChange add(const map::Keyframe& keyframe);
  [[nodiscard]] const gaussian::GaussianCloud& gaussians() const { return gaussians_; }
  [[nodiscard]] std::uint64_t map_hash() const { return hash_.value(); }
  [[nodiscard]] std::size_t chunk_count() const { return hash_.chunk_count(); }
  [[nodiscard]] const mapping::SeedStats& seed_stats() const { return seeder_.stats(); }

 private:
  mapping::MapSeeder seeder_;
  gaussian::GaussianCloud gaussians_;
  map::MapHash hash_;
};

}  // namespace edgesplat::optimise
