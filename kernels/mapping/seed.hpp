// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/map/keyframe.hpp"
#include "kernels/mapping/coverage_grid.hpp"
#include "kernels/mapping/id_allocator.hpp"

#include <cstdint>
#include <span>

namespace edgesplat::mapping {

struct SeedOptions {
  CoverageOptions coverage;
  float max_range_m = 60.0F;       ///< farther measured points are left out, 1..500
  float opacity = 0.9F;            ///< of a new Gaussian, 0.05..0.99
  float sigma_per_spacing = 1.0F;  ///< size of a Gaussian over the distance to its neighbours, 0.2..2
  float min_sigma_m = 0.01F;       ///< 0.001..0.1
  float max_sigma_m = 0.6F;        ///< 0.05..5
  float flat_ratio = 0.15F;        ///< thickness over width where the surface is a plane, 0.01..1
  float plane_max_ratio =
      0.04F;  ///< smallest over middle eigenvalue of the neighbours: below it is a plane, 0..1
};

struct SeedInput {
  std::span<const map::ColouredPoint> points_in_body;
  geometry::RigidTransform map_from_body;
  gaussian::Anchor anchor;
  /// The rig has a camera: points without colour are left out and may be seeded when they get one. Otherwise
  /// they are grey.
  bool has_camera = true;
  /// Of points made from a picture's pixels: the angle between neighbours, which gives their size at any
  /// range; 0: measured points, whose size is that of the gaps between them.
  float spacing_rad = 0.0F;
};

struct SeedStats {
  std::uint64_t points = 0;
  std::uint64_t uncoloured = 0;    ///< left out for want of a colour
  std::uint64_t out_of_range = 0;  ///< too far, or not finite
  std::uint64_t covered = 0;       ///< the map has them already
  std::uint64_t seeded = 0;        ///< new Gaussians
};

/// Turns LiDAR points into Gaussians where the map has none yet. Each is the mean of a keyframe's new points
/// in one cell, as wide as its neighbours are far, flattened along the local plane's normal. Remembers what
/// is covered. No I/O, no threads; deterministic: the same calls give the same Gaussians. Single-owner.
class MapSeeder {
 public:
  /// `ids` must outlive the seeder; several seeders on one thread may share it.
  MapSeeder(const SeedOptions& options, IdAllocator& ids)
      : options_(options), coverage_(options.coverage), ids_(ids) {}

  /// The new rows, SH degree 0, in the map frame; empty for a keyframe that shows nothing new. O(n log n).
  gaussian::GaussianCloud seed(const SeedInput& input);
  /// These Gaussians are there already: nothing is seeded where they are, but finer ones around them may be.
  void cover(const gaussian::GaussianCloud& cloud);
  [[nodiscard]] const SeedStats& stats() const { return stats_; }
  [[nodiscard]] std::size_t covered_cells() const { return coverage_.cells(); }

 private:
  SeedOptions options_;
  CoverageGrid coverage_;
  IdAllocator& ids_;
  SeedStats stats_;
};

}  // namespace edgesplat::mapping
