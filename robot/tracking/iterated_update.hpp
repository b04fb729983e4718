// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/filter_state.hpp"

#include <Eigen/LU>

namespace edgesplat::tracking {

/// `Errors` is kErrorSize where the calibration is held, else kFullSize: the state's errors, then the
/// calibration's.
template <int Errors>
using ErrorsVector = Eigen::Matrix<double, Errors, 1>;
template <int Errors>
using ErrorsMatrix = Eigen::Matrix<double, Errors, Errors>;

template <int Errors>
[[nodiscard]] ErrorsMatrix<Errors> covariance_of(const FilterBelief& belief);
template <int Errors>
void set_covariance(FilterBelief& belief, const ErrorsMatrix<Errors>& covariance);
template <int Errors>
[[nodiscard]] FilterState moved_by(const FilterState& state, const ErrorsVector<Errors>& error);
template <>
ErrorMatrix covariance_of<kErrorSize>(const FilterBelief& belief);
template <>
ErrorsMatrix<kFullSize> covariance_of<kFullSize>(const FilterBelief& belief);
template <>
void set_covariance<kErrorSize>(FilterBelief& belief, const ErrorMatrix& covariance);
template <>
void set_covariance<kFullSize>(FilterBelief& belief, const ErrorsMatrix<kFullSize>& covariance);
template <>
FilterState moved_by<kErrorSize>(const FilterState& state, const ErrorVector& error);
template <>
FilterState moved_by<kFullSize>(const FilterState& state, const ErrorsVector<kFullSize>& error);

/// A prior seen from the present state x: prior = x ⊞ (offset, covariance).
template <int Errors>
struct ShiftedPrior {
  ErrorsVector<Errors> offset;
  ErrorsMatrix<Errors> covariance;
};
template <int Errors = kErrorSize>
[[nodiscard]] ShiftedPrior<Errors> shift(const FilterBelief& prior, const FilterState& present);

/// What an update found before it was given up; the belief is what it was.
template <typename UpdateResult>
[[nodiscard]] UpdateResult without_update(const FilterBelief& prior, UpdateResult result) {
  result.belief = prior;
  result.updated = false;
  return result;
}

/// What residuals pull a prior to.
template <int Errors>
struct Correction {
  ErrorsVector<Errors> pulled;  ///< step from the prior
  ErrorsMatrix<Errors> learnt;  ///< by how much the covariance shrinks
};

/// One step of the iterated filter (FAST-LIO2, eq. 17-20) for residuals on the first N errors, with the
/// information A = H'R^-1 H and the gradient H'R^-1 r. With U the first N columns of the prior's covariance
/// P, the minimum of |r|^2_R + |x - prior|^2_P is at offset + U (I + A P_NN)^-1 (-gradient - A offset_N), and
/// its covariance is P - U (I + A P_NN)^-1 A U': only N x N systems, and P may be singular (states that are
/// known exactly).
template <int N, int Errors>
[[nodiscard]] Correction<Errors> correct(const ShiftedPrior<Errors>& prior,
                                         const Eigen::Matrix<double, N, N>& information,
                                         const Eigen::Matrix<double, N, 1>& gradient) {
  using Square = Eigen::Matrix<double, N, N>;
  const Square corner = prior.covariance.template topLeftCorner<N, N>();
  const Square gain = (Square::Identity() + information * corner).partialPivLu().inverse();
  const Eigen::Matrix<double, N, 1> pull = -gradient - information * prior.offset.template head<N>();
  const Eigen::Matrix<double, Errors, N> columns = prior.covariance.template leftCols<N>();
  return {columns * (gain * pull), columns * (gain * information) * columns.transpose()};
}

/// The same for residuals that depend on the errors as `rows` says, N linear functions of them: those of the
/// pose and of the calibration, which moves what is seen as a pose would. What N functions are told has
/// besides its noise errors that last, with the covariance `lasting` in proportion to their length: the
/// calibration is learnt with the gain, and to the certainty, of residuals that have them as noise. The
/// state's errors take no notice of it: they are against the map, which shares them.
template <int N>
[[nodiscard]] Correction<kFullSize> correct(const ShiftedPrior<kFullSize>& prior,
                                            const Eigen::Matrix<double, N, kFullSize>& rows,
                                            const Eigen::Matrix<double, N, N>& information,
                                            const Eigen::Matrix<double, N, 1>& gradient,
                                            const Eigen::Matrix<double, N, N>& lasting) {
  using Square = Eigen::Matrix<double, N, N>;
  const Eigen::Matrix<double, kFullSize, N> columns = prior.covariance * rows.transpose();
  const Square spread = rows * columns;
  const auto seen = [&](const Square& known, const Eigen::Matrix<double, N, 1>& pull, auto&& part) {
    const Square gain = (Square::Identity() + known * spread).partialPivLu().inverse();
    part(Eigen::Matrix<double, N, 1>(gain * (pull - known * (rows * prior.offset))), Square(gain * known));
  };
  Correction<kFullSize> correction;
  seen(information, -gradient, [&](const auto& pull, const Square& gain) {
    correction.pulled = columns * pull;
    correction.learnt = columns * gain * columns.transpose();
  });
  const Square duller = (Square::Identity() + information * lasting).partialPivLu().inverse();
  seen(duller * information, -duller * gradient, [&](const auto& pull, const Square& gain) {
    const auto calibration = columns.template bottomRows<kCalibrationErrors>();
    correction.pulled.template tail<kCalibrationErrors>() = calibration * pull;
    correction.learnt.template bottomRightCorner<kCalibrationErrors, kCalibrationErrors>() =
        calibration * gain * calibration.transpose();
  });
  return correction;
}

}  // namespace edgesplat::tracking
