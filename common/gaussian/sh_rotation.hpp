// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace edgesplat::gaussian {

/// How the colour's dependence on direction turns with a Gaussian: for coefficients c of bands 1..3 (signs
/// and order of the INRIA files), turned(c) seen from R * d is c seen from d. The sums are plain doubles in a
/// fixed order (+ - * / sqrt alone), so that robot and server come to the same bits. Source: Ivanic and
/// Ruedenberg, J. Phys. Chem. 100 (1996) 6342, with the correction of 102 (1998) 9099.
class ShRotation {
 public:
  static constexpr int kMaxDegree = 3;
  /// One colour's coefficients of bands 1..3, band by band: 3, 5, 7 of them.
  using Coefficients = std::array<double, 15>;

  /// By the rotation matrix `new_from_old`, row-major.
  explicit ShRotation(const std::array<double, 9>& new_from_old);

  /// Turns bands 1..degree (0..3); the others pass through.
  [[nodiscard]] Coefficients turned(int degree, const Coefficients& coefficients) const;

 private:
  using Band = std::array<std::array<double, 7>, 7>;  ///< rows and columns m = -l..l at m + l

  std::array<Band, kMaxDegree> bands_{};
};

}  // namespace edgesplat::gaussian
