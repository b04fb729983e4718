// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/filter_state.hpp"

#include <Eigen/LU>

namespace edgesplat::tracking {

/// A prior seen from the present state x: prior = x ⊞ (offset, covariance).
struct ShiftedPrior {
  ErrorVector offset;
  ErrorMatrix covariance;
};
[[nodiscard]] ShiftedPrior shift(const FilterBelief& prior, const FilterState& present);

/// What residuals pull a prior to.
struct Correction {
  ErrorVector pulled;  ///< step from the prior
  ErrorMatrix learnt;  ///< by how much the covariance shrinks
};

/// One step of the iterated filter (FAST-LIO2, eq. 17-20) for residuals on the first N errors, with the
/// information A = H'R^-1 H and the gradient H'R^-1 r. With U the first N columns of the prior's covariance
/// P, the minimum of |r|^2_R + |x - prior|^2_P is at offset + U (I + A P_NN)^-1 (-gradient - A offset_N), and
/// its covariance is P - U (I + A P_NN)^-1 A U': only N x N systems, and P may be singular (states that are
/// known exactly).
template <int N>
[[nodiscard]] Correction correct(const ShiftedPrior& prior, const Eigen::Matrix<double, N, N>& information,
                                 const Eigen::Matrix<double, N, 1>& gradient) {
  using Square = Eigen::Matrix<double, N, N>;
  const Square corner = prior.covariance.topLeftCorner<N, N>();
  const Square gain = (Square::Identity() + information * corner).partialPivLu().inverse();
  const Eigen::Matrix<double, N, 1> pull = -gradient - information * prior.offset.head<N>();
  const Eigen::Matrix<double, kErrorSize, N> columns = prior.covariance.leftCols<N>();
  return {columns * (gain * pull), columns * (gain * information) * columns.transpose()};
}

}  // namespace edgesplat::tracking
