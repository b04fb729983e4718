// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/train/gaussian_backward.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::mapping {

/// What the pictures since the last densification said about one Gaussian.
struct RowStatistics {
  float gradient_sum = 0.0F;   ///< of the lengths of dL by the centre, in half picture widths (as in 3DGS)
  float weight_sum = 0.0F;     ///< of blending weights: pixels it filled
  float radius_max_px = 0.0F;  ///< of its box on the screen
  std::uint32_t sightings = 0;
};

inline void add_sighting(const train::Sighting& sighting, float half_width_px, RowStatistics& row) {
  row.gradient_sum += sighting.centre_gradient_px * half_width_px;
  row.weight_sum += sighting.weight;
  row.radius_max_px = row.radius_max_px > sighting.radius_px ? row.radius_max_px : sighting.radius_px;
  ++row.sightings;
}

/// Keeps the given rows, ascending.
inline void keep_rows(std::span<const std::uint32_t> rows, std::vector<RowStatistics>& statistics) {
  for (std::size_t to = 0; to < rows.size(); ++to) statistics[to] = statistics[rows[to]];
  statistics.resize(rows.size());
}

}  // namespace edgesplat::mapping
