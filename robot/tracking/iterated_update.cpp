// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/iterated_update.hpp"

#include "common/geometry/so3.hpp"

namespace edgesplat::tracking {

ShiftedPrior shift(const FilterBelief& prior, const FilterState& present) {
  ShiftedPrior shifted{minus(prior.state, present), prior.covariance};
  const Eigen::Matrix3d turn = geometry::so3_right_jacobian_inverse(shifted.offset.segment<3>(kRot));
  shifted.covariance.topRows<3>() = (turn * shifted.covariance.topRows<3>()).eval();
  shifted.covariance.leftCols<3>() = (shifted.covariance.leftCols<3>() * turn.transpose()).eval();
  return shifted;
}

}  // namespace edgesplat::tracking
