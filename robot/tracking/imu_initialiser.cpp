// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/imu_initialiser.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

/// A MEMS accelerometer's bias over the years: what levelling at rest cannot see.
constexpr double kAccelBiasSigma_mps2 = 0.1;
/// Of the first speed where neither the IMU feels motion nor the scans see any. Were it as unknown as that of
/// a start in motion, the first scans' chance would decide about it where a direction is not seen.
constexpr double kSpeedSigma_mps = 0.1;
/// A mean force further from gravity's is a push, or an IMU in the wrong unit.
constexpr double kRestForceTolerance_mps2 = 0.5;

template <typename Field>
ImuInitialiser::Spread spread_of(const std::vector<sync::GroupImu>& samples, Field field) {
  ImuInitialiser::Spread spread;
  const auto n = static_cast<double>(samples.size());
  for (const auto& sample : samples) spread.mean += field(sample) / n;
  double squares = 0.0;
  for (const auto& sample : samples) squares += (field(sample) - spread.mean).squaredNorm() / n;
  spread.deviation = std::sqrt(squares);
  return spread;
}

}  // namespace

std::optional<FilterBelief> ImuInitialiser::add(const std::vector<sync::GroupImu>& imu) {
  const auto spans = [&](std::size_t first) {
    return samples_.size() >= first + 3 &&
           samples_.back().stamp - samples_[first].stamp >= from_seconds(config_.init_s);
  };
  std::size_t first = 0;
  while (spans(first)) ++first;  // those were judged before
  samples_.erase(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(first));
  for (const auto& sample : imu) {
    if (samples_.empty() || sample.stamp > samples_.back().stamp) samples_.push_back(sample);
  }
  if (!spans(0)) return std::nullopt;
  const Spread accel = spread_of(samples_, [](const sync::GroupImu& s) -> Vector3d { return s.accel_mps2; });
  const Spread gyro = spread_of(samples_, [](const sync::GroupImu& s) -> Vector3d { return s.gyro_radps; });
  if (!at_rest(accel, gyro)) return std::nullopt;
  return solve(accel, gyro);
}

// The spread may exceed the limits by what white noise at the IMU's rate explains.
bool ImuInitialiser::at_rest(const Spread& accel, const Spread& gyro) const {
  const auto limit = [&](double motion, double density) {
    return std::sqrt(motion * motion + 3.0 * density * density * model_.rate_hz);
  };
  return accel.deviation < limit(config_.init_accel_spread_max_mps2, model_.accel_noise_mps2_per_sqrt_hz) &&
         gyro.deviation < limit(config_.init_gyro_rate_max_radps, model_.gyro_noise_radps_per_sqrt_hz) &&
         gyro.mean.norm() < config_.init_gyro_rate_max_radps &&
         std::abs(accel.mean.norm() - kGravity_mps2) < kRestForceTolerance_mps2;
}

FilterBelief ImuInitialiser::solve(const Spread& accel, const Spread& gyro) const {
  FilterBelief belief;
  belief.state.odom_from_body.rotation = Eigen::Quaterniond::FromTwoVectors(accel.mean, Vector3d::UnitZ());
  belief.state.gravity_in_odom_mps2 = Vector3d(0.0, 0.0, -kGravity_mps2);
  belief.state.gyro_bias_radps = gyro.mean;
  belief.covariance = initial_covariance(belief.state, accel, gyro);
  return belief;
}

// Odom is defined by the first pose: its rotation and position are exact, gravity's direction carries the
// doubt. At rest the mean force is bias - R'g: whatever the bias is wrong by, gravity is wrong by the same,
// turned by R.
ErrorMatrix ImuInitialiser::initial_covariance(const FilterState& state, const Spread& accel,
                                               const Spread& gyro) const {
  const auto samples = static_cast<double>(samples_.size());
  ErrorMatrix p = ErrorMatrix::Zero();
  const auto set = [&](int index, double sigma) {
    p.diagonal().segment<3>(index).setConstant(sigma * sigma);
  };
  set(kRot, 1e-4);
  set(kPos, 1e-4);
  set(kAccelBias, kAccelBiasSigma_mps2);
  set(kVel, kSpeedSigma_mps);
  set(kGyroBias, 1e-4 + gyro.deviation / std::sqrt(samples));
  const Eigen::Matrix3d rotation = state.odom_from_body.rotation.toRotationMatrix();
  const double bias_variance = kAccelBiasSigma_mps2 * kAccelBiasSigma_mps2;
  set(kGravity, std::hypot(kAccelBiasSigma_mps2, 0.005 + accel.deviation / std::sqrt(samples)));
  p.block<3, 3>(kGravity, kAccelBias) = bias_variance * rotation;
  p.block<3, 3>(kAccelBias, kGravity) = bias_variance * rotation.transpose();
  // Gravity's length is known: a measurement of its z.
  constexpr int kDown = kGravity + 2;
  const ErrorVector column = p.col(kDown);
  p -= column * column.transpose() / (column(kDown) + kGravityNormSigma_mps2 * kGravityNormSigma_mps2);
  return p;
}

}  // namespace edgesplat::tracking
