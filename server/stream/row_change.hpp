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

/// One Gaussian in full precision.
struct TrueRow {
  const gaussian::GaussianCloud& cloud;
  std::size_t row;
};
/// The same as the robot holds it.
struct HeldRow {
  const map::QuantisedRows& rows;
  std::size_t row;
};

/// Compares a Gaussian with what the robot holds of it. `now` ends with the same Gaussian, quantised in the
/// held one's chunk: fields that differ by no more than `tolerance` times what nobody sees (a twentieth of
/// the smallest axis, 5 % of a scale, a turn that moves the tips by a tenth of the smallest axis, 1/100 of
/// opacity or colour, a step of SH) are set back to the held value there, and cost no bytes then.
[[nodiscard]] RowChange settle_change(const TrueRow& truth, const HeldRow& held, float tolerance,
                                      map::QuantisedRows& now);

}  // namespace edgesplat::stream
