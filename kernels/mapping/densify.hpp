// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_id.hpp"
#include "kernels/mapping/id_allocator.hpp"
#include "kernels/mapping/optimiser.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::mapping {

struct DensifyOptions {
  /// Mean length of dL by the centre, in half picture widths, above which a Gaussian is cloned or split
  /// (3DGS), 1e-5..1e-2
  float gradient = 2e-4F;
  float split_sigma_m = 0.05F;      ///< longer ones are split, shorter ones cloned, 0.001..1
  float grow_share = 0.1F;          ///< at most so many new rows as a share of the map, 0..1
  float min_opacity = 0.005F;       ///< below it a Gaussian is removed, 0..0.7
  float max_radius_px = 500.0F;     ///< larger on the screen: removed, > 0
  float max_sigma_m = 5.0F;         ///< longer in the map: removed, > 0
  float min_weight_px = 0.05F;      ///< fills fewer pixels than this a sighting: removed, 0..10
  std::uint32_t min_sightings = 4;  ///< fewer say nothing about gradient and weight, 1..1000
  /// With the budget used up, at most this share of the map goes, least useful first, for what needs room,
  /// 0..0.5
  float shed_share = 0.02F;
  std::size_t max_rows = ~std::size_t{0};  ///< the budget, where it is less than the optimiser's
};

struct DensifyReport {
  std::vector<gaussian::GaussianId> removed;
  std::size_t transparent = 0, large = 0, idle = 0, shed = 0;  ///< why they were removed
  std::size_t switched_off = 0;                                ///< of them, by differentiable pruning
  std::size_t cloned = 0, split = 0;
  std::size_t refused = 0;  ///< wanted to grow, had no room
};

/// Prunes what does not help and grows where pictures disagree, from the statistics since the last call,
/// which it then clears. A clone shares its opacity with its parent so that the picture stays; a split leaves
/// the parent as one half of itself, moved and shrunk along its longest axis, so that it keeps its id. New
/// rows get ids from `ids` and their parent's anchor; they lie at the end. Keeps to the optimiser's budget.
/// No randomness: the same calls give the same map. O(n log n).
DensifyReport densify(Optimiser& optimiser, const DensifyOptions& options, IdAllocator& ids);

}  // namespace edgesplat::mapping
