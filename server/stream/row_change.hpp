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

/// Compares a Gaussian with what the robot holds of it. Fields count as changed that differ by more than
/// `tolerance` times what nobody sees: a twentieth of the smallest axis, 5 % of a scale, a turn that moves
/// the tips by a tenth of the smallest axis, 1/100 of opacity or colour, a step of SH.
[[nodiscard]] RowChange measure_change(const TrueRow& truth, const HeldRow& held, float tolerance);

/// Appends the Gaussian to `now`, quantised in the held one's chunk, the fields that are not in `fields` as
/// held: they cost no bytes then. False, and nothing is appended, where that is what the robot holds.
bool append_settled(const TrueRow& truth, const HeldRow& held, map::FieldMask fields,
                    map::QuantisedRows& now);

}  // namespace edgesplat::stream
