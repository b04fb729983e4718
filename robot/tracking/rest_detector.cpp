// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/rest_detector.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kQuiet_s = 0.5;
constexpr std::size_t kMinSamples = 5;
/// Means farther from what rest makes than this many standard deviations are motion.
constexpr double kMeanGate = 2.5;
/// The spread of the samples may exceed that of white noise by this factor.
constexpr double kSpreadGate = 1.5;

struct Signal {
  Vector3d mean = Vector3d::Zero();
  double spread = 0.0;  ///< root of the axes' summed variances
};

template <typename Field>
Signal signal_of(std::span<const sync::GroupImu> imu, Field field) {
  Signal signal;
  const auto n = static_cast<double>(imu.size());
  for (const auto& sample : imu) signal.mean += field(sample) / n;
  double squares = 0.0;
  for (const auto& sample : imu) squares += (field(sample) - signal.mean).squaredNorm() / n;
  signal.spread = std::sqrt(squares);
  return signal;
}

}  // namespace

bool RestDetector::is_quiet(std::span<const sync::GroupImu> imu, const FilterState& state) const {
  const Signal force = signal_of(imu, [](const sync::GroupImu& s) -> Vector3d { return s.accel_mps2; });
  const Signal rate = signal_of(imu, [](const sync::GroupImu& s) -> Vector3d { return s.gyro_radps; });
  const auto quiet = [&](const Signal& signal, const Vector3d& at_rest, double density) {
    const double sample_sigma = density * std::sqrt(3.0 * model_.rate_hz);
    const double mean_sigma = sample_sigma / std::sqrt(static_cast<double>(imu.size()));
    return signal.spread < kSpreadGate * sample_sigma &&
           (signal.mean - at_rest).norm() < kMeanGate * mean_sigma;
  };
  const Vector3d weight = -(state.odom_from_body.rotation.conjugate() * state.gravity_in_odom_mps2);
  return quiet(force, weight + state.accel_bias_mps2, model_.accel_noise_mps2_per_sqrt_hz) &&
         quiet(rate, state.gyro_bias_radps, model_.gyro_noise_radps_per_sqrt_hz);
}

bool RestDetector::add(std::span<const sync::GroupImu> imu, const FilterState& state) {
  if (imu.size() < kMinSamples || !is_quiet(imu, state)) {
    quiet_s_ = 0.0;
    return false;
  }
  quiet_s_ += to_seconds(imu.back().stamp - imu.front().stamp);
  return quiet_s_ >= kQuiet_s;
}

Eigen::Vector3d seen_velocity_mps(const FilterState& state, const Eigen::Matrix3d& unseen) {
  return state.velocity_in_odom_mps - unseen * state.velocity_in_odom_mps;
}

void hold_velocity(FilterBelief& belief, const Eigen::Matrix3d& directions_in_odom, double sigma_mps) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(directions_in_odom);
  for (int k = 0; k < 3; ++k) {
    if (solver.eigenvalues()(k) < 0.5) continue;
    const Vector3d direction = solver.eigenvectors().col(k);
    const ErrorVector column = belief.covariance.middleCols<3>(kVel) * direction;
    const double variance = direction.dot(column.segment<3>(kVel)) + sigma_mps * sigma_mps;
    const double residual = -direction.dot(belief.state.velocity_in_odom_mps);
    belief.state = plus(belief.state, column * (residual / variance));
    belief.covariance -= column * column.transpose() / variance;
    // What the rest tells of the calibration, it tells through errors that both share: only considered.
    if (belief.calibration)
      belief.calibration->with_state -=
          column * (direction.transpose() * belief.calibration->with_state.middleRows<3>(kVel)) / variance;
  }
}

}  // namespace edgesplat::tracking
