// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/propagation.hpp"

#include "common/geometry/so3.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::tracking {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The specific force that keeps the velocity: it only cancels gravity.
Vector3d weightless(const FilterState& state) {
  return state.accel_bias_mps2 - state.odom_from_body.rotation.conjugate() * state.gravity_in_odom_mps2;
}

MotionInput sample_between(const sync::GroupImu& first, const sync::GroupImu& second, HostTime begin,
                           HostTime end) {
  const double span_s = to_seconds(second.stamp - first.stamp);
  const double middle = 0.5 * (to_seconds(begin - first.stamp) + to_seconds(end - first.stamp)) / span_s;
  return {first.gyro_radps + middle * (second.gyro_radps - first.gyro_radps),
          first.accel_mps2 + middle * (second.accel_mps2 - first.accel_mps2)};
}

/// Steps a prediction forward in time and records the way.
class Walker {
 public:
  Walker(const FilterBelief& belief, HostTime begin) : now_(begin) {
    prediction_.belief = belief;
    record();
  }
  void step(const MotionInput& input, const MotionNoise& noise, HostTime until) {
    if (until <= now_) return;
    propagate(prediction_.belief, input, noise, to_seconds(until - now_));
    now_ = until;
    record();
  }
  /// Uniform motion in steps of at most 10 ms (curved ways stay curved in the knots).
  void coast(const Vector3d& gyro_radps, const MotionNoise& noise, HostTime until) {
    constexpr auto kStep = std::chrono::milliseconds(10);
    constexpr int kMaxSteps = 1000;
    const nanoseconds step_length = std::max<nanoseconds>(kStep, (until - now_) / kMaxSteps);
    while (now_ < until) {
      const HostTime next = std::min<HostTime>(now_ + step_length, until);
      step({gyro_radps, weightless(prediction_.belief.state)}, noise, next);
    }
  }
  [[nodiscard]] HostTime now() const { return now_; }
  Prediction& prediction() { return prediction_; }

 private:
  void record() { prediction_.path.push_back({now_, prediction_.belief.state.odom_from_body}); }

  Prediction prediction_;
  HostTime now_;
};

}  // namespace

MotionNoise imu_noise(const sensor::ImuModel& model) {
  return {model.gyro_noise_radps_per_sqrt_hz, model.accel_noise_mps2_per_sqrt_hz,
          model.gyro_bias_walk_radps2_per_sqrt_hz, model.accel_bias_walk_mps3_per_sqrt_hz};
}

FilterState integrate(const FilterState& state, const MotionInput& input, double dt_s) {
  const Vector3d turn = (input.gyro_radps - state.gyro_bias_radps) * dt_s;
  const Eigen::Quaterniond rotation_middle = state.odom_from_body.rotation * geometry::so3_exp(0.5 * turn);
  const Vector3d accel_in_odom =
      rotation_middle * (input.accel_mps2 - state.accel_bias_mps2) + state.gravity_in_odom_mps2;
  FilterState next = state;
  next.odom_from_body.rotation = (state.odom_from_body.rotation * geometry::so3_exp(turn)).normalized();
  next.odom_from_body.translation_m += state.velocity_in_odom_mps * dt_s + 0.5 * dt_s * dt_s * accel_in_odom;
  next.velocity_in_odom_mps += dt_s * accel_in_odom;
  return next;
}

ErrorMatrix transition(const FilterState& state, const MotionInput& input, double dt_s) {
  const Vector3d turn = (input.gyro_radps - state.gyro_bias_radps) * dt_s;
  const Matrix3d rotation = state.odom_from_body.rotation.toRotationMatrix();
  const Matrix3d half_turn = geometry::so3_exp(0.5 * turn).toRotationMatrix();
  const Matrix3d rotation_middle = rotation * half_turn;
  const Vector3d force = input.accel_mps2 - state.accel_bias_mps2;
  ErrorMatrix f = ErrorMatrix::Identity();
  f.block<3, 3>(kRot, kRot) = geometry::so3_exp(turn).toRotationMatrix().transpose();
  f.block<3, 3>(kRot, kGyroBias) = -dt_s * geometry::so3_right_jacobian(turn);
  f.block<3, 3>(kVel, kRot) = -dt_s * rotation * geometry::hat(half_turn * force);
  f.block<3, 3>(kVel, kGyroBias) =
      0.5 * dt_s * dt_s * rotation_middle * geometry::hat(force) * geometry::so3_right_jacobian(0.5 * turn);
  f.block<3, 3>(kVel, kAccelBias) = -dt_s * rotation_middle;
  f.block<3, 3>(kVel, kGravity) = dt_s * Matrix3d::Identity();
  f.block<3, kErrorSize>(kPos, 0) = 0.5 * dt_s * f.block<3, kErrorSize>(kVel, 0);
  f.block<3, 3>(kPos, kPos).setIdentity();
  f.block<3, 3>(kPos, kVel) = dt_s * Matrix3d::Identity();
  return f;
}

void propagate(FilterBelief& belief, const MotionInput& input, const MotionNoise& noise, double dt_s) {
  const ErrorMatrix f = transition(belief.state, input, dt_s);
  belief.state = integrate(belief.state, input, dt_s);
  const auto moving = f.topRows<kGyroBias>();  // biases and gravity stay as they are
  belief.covariance.topRows<kGyroBias>() = (moving * belief.covariance).eval();
  belief.covariance.leftCols<kGyroBias>() = (belief.covariance * moving.transpose()).eval();
  // No motion changes the calibration.
  if (belief.calibration) {
    auto& with_state = belief.calibration->with_state;
    with_state.topRows<kGyroBias>() = (moving * with_state).eval();
  }
  const auto add = [&](int index, double density) {
    belief.covariance.diagonal().segment<3>(index).array() += density * density * dt_s;
  };
  add(kRot, noise.rotation_radps_per_sqrt_hz);
  add(kVel, noise.velocity_mps2_per_sqrt_hz);
  add(kGyroBias, noise.gyro_bias_radps2_per_sqrt_hz);
  add(kAccelBias, noise.accel_bias_mps3_per_sqrt_hz);
  // White acceleration also moves the position within the step: the exact integral's remaining terms.
  const double accel_variance = noise.velocity_mps2_per_sqrt_hz * noise.velocity_mps2_per_sqrt_hz;
  for (int axis = 0; axis < 3; ++axis) {
    belief.covariance(kPos + axis, kPos + axis) += accel_variance * dt_s * dt_s * dt_s / 3.0;
    belief.covariance(kPos + axis, kVel + axis) += accel_variance * dt_s * dt_s / 2.0;
    belief.covariance(kVel + axis, kPos + axis) += accel_variance * dt_s * dt_s / 2.0;
  }
}

Prediction predict_with_imu(const FilterBelief& belief, std::span<const sync::GroupImu> imu,
                            const sensor::ImuModel& model, const MotionNoise& free_motion,
                            Interval interval) {
  const MotionNoise noise = imu_noise(model);
  const nanoseconds hold = from_seconds(3.0 / std::max(model.rate_hz, 1.0));
  Walker walker(belief, interval.begin);
  // The bias is a real one here: bridges keep the rate that was measured next to them.
  const auto bridge = [&](const sync::GroupImu& sample, HostTime until) {
    if (until <= walker.now()) return;
    const nanoseconds age = std::max(until, sample.stamp) - std::min(walker.now(), sample.stamp);
    if (age <= hold) return walker.step({sample.gyro_radps, sample.accel_mps2}, noise, until);
    walker.prediction().imu_covers = false;
    walker.coast(sample.gyro_radps, free_motion, until);
  };
  bridge(imu.front(), std::min(imu.front().stamp, interval.end));
  for (std::size_t i = 0; i + 1 < imu.size(); ++i) {
    const HostTime begin = std::max(imu[i].stamp, interval.begin);
    const HostTime end = std::min(imu[i + 1].stamp, interval.end);
    if (end <= begin || end <= walker.now()) continue;
    if (imu[i + 1].stamp - imu[i].stamp > 2 * hold) {
      bridge(imu[i], end);
    } else {
      walker.step(sample_between(imu[i], imu[i + 1], begin, end), noise, end);
    }
  }
  bridge(imu.back(), interval.end);
  return std::move(walker.prediction());
}

Prediction predict_without_imu(const FilterBelief& belief, const MotionNoise& free_motion,
                               Interval interval) {
  Walker walker(belief, interval.begin);
  walker.coast(Vector3d::Zero(), free_motion, interval.end);
  return std::move(walker.prediction());
}

std::vector<PathKnot> uniform_path(const FilterState& state, HostTime at, Interval interval) {
  constexpr int kSteps = 10;
  std::vector<PathKnot> path;
  for (int i = 0; i <= kSteps; ++i) {
    const HostTime stamp = interval.begin + (interval.end - interval.begin) * i / kSteps;
    const double dt_s = to_seconds(stamp - at);
    path.push_back({stamp, state.odom_from_body});
    geometry::RigidTransform& pose = path.back().odom_from_body;
    pose.rotation = (pose.rotation * geometry::so3_exp(-dt_s * state.gyro_bias_radps)).normalized();
    pose.translation_m += dt_s * state.velocity_in_odom_mps;
  }
  return path;
}

void correct_path(std::vector<PathKnot>& path, HostTime at, const FilterState& predicted,
                  const FilterState& corrected) {
  const geometry::RigidTransform moved = corrected.odom_from_body * predicted.odom_from_body.inverse();
  const Vector3d faster = corrected.velocity_in_odom_mps - moved.rotation * predicted.velocity_in_odom_mps;
  const Vector3d turn = predicted.gyro_bias_radps - corrected.gyro_bias_radps;
  for (PathKnot& knot : path) {
    const double dt_s = to_seconds(knot.stamp - at);
    knot.odom_from_body = moved * knot.odom_from_body;
    knot.odom_from_body.translation_m += dt_s * faster;
    knot.odom_from_body.rotation =
        (knot.odom_from_body.rotation * geometry::so3_exp(dt_s * turn)).normalized();
  }
}

}  // namespace edgesplat::tracking
