// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/keyframe.hpp"
#include "kernels/mapping/seed.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::optimise {

/// What a keyframe changed.
struct MapChange {
  std::vector<std::uint32_t> changed_rows;  ///< new Gaussians, at the end of the map
};

/// The server's map of one robot's session, grown keyframe by keyframe. `map` and `odom` are one frame until
/// poses are corrected. Single-owner.
class MapBuilder {
 public:
  /// `ids` must outlive this.
  MapBuilder(const mapping::SeedOptions& options, mapping::IdAllocator& ids) : seeder_(options, ids) {}

  MapChange add(const map::Keyframe& keyframe);
  [[nodiscard]] const gaussian::GaussianCloud& gaussians() const { return gaussians_; }
  [[nodiscard]] const mapping::SeedStats& seed_stats() const { return seeder_.stats(); }

 private:
  mapping::MapSeeder seeder_;
  gaussian::GaussianCloud gaussians_;
};

}  // namespace edgesplat::optimise
