// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/quantised.hpp"

namespace edgesplat::stream {

/// How much one Gaussian differs from what the robot holds of it.
struct RowChange {
  map::FieldMask fields = 0;  ///< that differ by more than the tolerance
  float priority = 0.0F;      ///< sum of the differences as the eye weighs them, times opacity and size
};

/// Compares row `row` of `now` with row `held_row` of `held` (same chunk, same SH degree). Fields that differ
/// by no more than `tolerance` times what nobody sees (a twentieth of the smallest axis, 3 % of a scale, a
/// quarter of a degree, 1/128 of opacity or colour) are set back to the held value: they cost no bytes then.
[[nodiscard]] RowChange settle_change(map::QuantisedRows& now, std::size_t row,
                                      const map::QuantisedRows& held, std::size_t held_row, float tolerance);

}  // namespace edgesplat::stream
