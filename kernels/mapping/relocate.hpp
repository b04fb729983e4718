// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_id.hpp"
#include "kernels/mapping/id_allocator.hpp"
#include "kernels/mapping/optimiser.hpp"

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace edgesplat::mapping {

/// What each of `copies` equal Gaussians at one place must be so that together they look as one of `opacity`
/// did (Kheradmand 2024, eq. 9): the opacity that blends to the same, and the factor of the scales for which
/// the sums over a line through the centre agree. `opacity` in (0, 1), copies 1..51.
struct SharedLook {
  float opacity;
  float scale_factor;
};
[[nodiscard]] SharedLook shared_look(float opacity, std::size_t copies);

struct RelocateOptions {
  float min_opacity = 0.005F;  ///< below it a Gaussian is dead, 0..0.7
  float grow_share = 0.05F;    ///< at most so many new rows as a share of the map each time, 0..1
  std::size_t max_rows = 1'000'000;
  float max_sigma_m = 5.0F;  ///< longer ones are dead too, > 0
  /// Noise of the means: Langevin's term, as a share of the covariance a metre, 0 (off)..1e4
  float noise_per_m = 0.0F;
  std::uint32_t seed = 1;
};

struct RelocateReport {
  std::vector<gaussian::GaussianId> removed;  ///< the dead
  std::size_t moved = 0;                      ///< new rows in their stead
  std::size_t added = 0;                      ///< new rows beyond that
};

/// Densification as sampling (3DGS as MCMC, Kheradmand 2024): dead Gaussians move to where live ones are, a
/// place being drawn in proportion to its opacity, and the map grows by a share each time up to a number of
/// rows. The picture stays about as it was, since all at one place share its look. A Gaussian that moves
/// gets a new id, for ids are for life. Deterministic. Single-owner.
class Relocator {
 public:
  explicit Relocator(const RelocateOptions& options) : options_(options), random_(options.seed) {}

  /// From the next relocation on; as RelocateOptions'.
  void set_growth(float grow_share, std::size_t max_rows) {
    options_.grow_share = grow_share;
    options_.max_rows = max_rows;
  }
  RelocateReport relocate(Optimiser& optimiser, IdAllocator& ids);
  /// Moves the means of faint Gaussians (opacity below 0.05 or so) at random within their own extent, by
  /// `rate_share` of the option's noise. O(n), most of it looking at opacities.
  void shake(Optimiser& optimiser, float rate_share);

 private:
  RelocateOptions options_;
  std::mt19937 random_;
};

}  // namespace edgesplat::mapping
