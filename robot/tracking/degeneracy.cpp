// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/degeneracy.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>

namespace edgesplat::tracking {
namespace {

/// Signals up to the first are noise, from the second on they count fully.
constexpr double kFrozenSignal = 1.7;
constexpr double kFullSignal = 4.0;
/// Least noise, as a share of the mean information of rotation or position: keeps the problem regular where
/// planes are perfect.
constexpr double kLeastNoise = 1e-5;

/// The projector with one more direction in its span.
void widen(Eigen::Matrix3d& projector, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d fresh = direction - projector * direction;
  if (fresh.norm() < 1e-3 * direction.norm()) return;
  projector += fresh * fresh.transpose() / fresh.squaredNorm();
}

void freeze(const Vector6d& direction, ObservedPart& part) {
  ++part.frozen;
  if (kLever_m * direction.head<3>().norm() > direction.tail<3>().norm()) {
    widen(part.frozen_turns, direction.head<3>());
  } else {
    widen(part.frozen_steps, direction.tail<3>());
  }
}

}  // namespace

ObservedPart keep_observed(const NormalEquations& equations) {
  Matrix6d noise = equations.noise;
  for (int block = 0; block < 6; block += 3) {
    const double mean = equations.information.block<3, 3>(block, block).trace() / 3.0;
    noise.diagonal().segment<3>(block).array() += kLeastNoise * mean + 1e-9;
  }
  // information v = l noise v with v' noise v = 1: information = sum l (noise v)(noise v)'.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> solver(equations.information, noise);
  ObservedPart part;
  if (solver.info() != Eigen::Success) {
    part.frozen = 6;
    part.frozen_steps.setIdentity();
    part.frozen_turns.setIdentity();
    return part;
  }
  for (int k = 0; k < 6; ++k) {
    const double signal = solver.eigenvalues()(k);
    const double trust = std::clamp((signal - kFrozenSignal) / (kFullSignal - kFrozenSignal), 0.0, 1.0);
    const Vector6d direction = solver.eigenvectors().col(k);
    if (trust <= 0.0) {
      freeze(direction, part);
      continue;
    }
    const Vector6d functional = noise * direction;
    const double share = trust * (signal - 1.0) / signal;
    part.information += share * signal * functional * functional.transpose();
    part.gradient += share * direction.dot(equations.gradient) * functional;
  }
  const Vector6d weakest = solver.eigenvectors().col(0);
  const double step = std::max(weakest.tail<3>().norm(), 1e-12);
  part.weakest.signal = solver.eigenvalues()(0);
  part.weakest.turn = weakest.head<3>() / step;
  part.weakest.step_in_odom = weakest.tail<3>() / step;
  return part;
}

}  // namespace edgesplat::tracking
