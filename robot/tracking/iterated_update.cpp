// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/iterated_update.hpp"

#include "common/geometry/so3.hpp"

namespace edgesplat::tracking {

template <>
ErrorMatrix covariance_of<kErrorSize>(const FilterBelief& belief) {
  return belief.covariance;
}

template <>
ErrorsMatrix<kFullSize> covariance_of<kFullSize>(const FilterBelief& belief) {
  const CalibrationDoubt& doubt = *belief.calibration;
  ErrorsMatrix<kFullSize> full;
  full << belief.covariance, doubt.with_state, doubt.with_state.transpose(), doubt.covariance;
  return full;
}

template <>
void set_covariance<kErrorSize>(FilterBelief& belief, const ErrorMatrix& covariance) {
  belief.covariance = covariance;
}

template <>
void set_covariance<kFullSize>(FilterBelief& belief, const ErrorsMatrix<kFullSize>& covariance) {
  belief.covariance = covariance.topLeftCorner<kErrorSize, kErrorSize>();
  belief.calibration = {covariance.bottomRightCorner<kCalibrationErrors, kCalibrationErrors>(),
                        covariance.topRightCorner<kErrorSize, kCalibrationErrors>()};
}

template <>
FilterState moved_by<kErrorSize>(const FilterState& state, const ErrorVector& error) {
  return plus(state, error);
}

template <>
FilterState moved_by<kFullSize>(const FilterState& state, const ErrorsVector<kFullSize>& error) {
  FilterState sum = plus(state, ErrorVector(error.head<kErrorSize>()));
  sum.calibration = plus(state.calibration, CalibrationVector(error.tail<kCalibrationErrors>()));
  return sum;
}

template <int Errors>
ShiftedPrior<Errors> shift(const FilterBelief& prior, const FilterState& present) {
  ShiftedPrior<Errors> shifted;
  shifted.offset.template head<kErrorSize>() = minus(prior.state, present);
  if constexpr (Errors == kFullSize)
    shifted.offset.template tail<kCalibrationErrors>() = minus(prior.state.calibration, present.calibration);
  shifted.covariance = covariance_of<Errors>(prior);
  const Eigen::Matrix3d turn = geometry::so3_right_jacobian_inverse(shifted.offset.template segment<3>(kRot));
  shifted.covariance.template topRows<3>() = (turn * shifted.covariance.template topRows<3>()).eval();
  shifted.covariance.template leftCols<3>() =
      (shifted.covariance.template leftCols<3>() * turn.transpose()).eval();
  return shifted;
}
template ShiftedPrior<kErrorSize> shift<kErrorSize>(const FilterBelief&, const FilterState&);
template ShiftedPrior<kFullSize> shift<kFullSize>(const FilterBelief&, const FilterState&);

}  // namespace edgesplat::tracking
