// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/pose_stream.hpp"

#include "robot/tracking/propagation.hpp"

namespace edgesplat::tracking {
namespace {

bool is_valid(const TrackedGroup& tracked) {
  const TrackingState state = tracked.health.state;
  return state != TrackingState::kInitialising && state != TrackingState::kLost &&
         tracked.odom_from_body.is_finite() && tracked.velocity_in_odom_mps.allFinite();
}

}  // namespace

void PoseStream::correct(const TrackedGroup& tracked) {
  const std::lock_guard lock(mutex_);
  state_.reset();
  tracked_at_ = now_ = tracked.stamp;
  while (samples_.size() > 1 && samples_[1].stamp <= tracked.stamp) samples_.pop_front();
  if (!is_valid(tracked)) return;
  FilterState state;
  state.odom_from_body = tracked.odom_from_body;
  state.velocity_in_odom_mps = tracked.velocity_in_odom_mps;
  state.gyro_bias_radps = tracked.gyro_bias_radps;
  state.accel_bias_mps2 = tracked.accel_bias_mps2;
  state.gravity_in_odom_mps2 = tracked.gravity_in_odom_mps2;
  state_ = state;
  for (std::size_t i = 1; i < samples_.size(); ++i)
    if (!step(samples_[i - 1], samples_[i])) return;
}

/// Carries the state to the second sample; false, and no state any more, over a hole.
bool PoseStream::step(const sync::GroupImu& from, const sync::GroupImu& to) {
  if (to.stamp <= now_) return true;
  if (to.stamp - from.stamp > config_.longest_hole || from.stamp - now_ > config_.longest_hole) {
    state_.reset();
    return false;
  }
  const MotionInput input{0.5 * (from.gyro_radps + to.gyro_radps), 0.5 * (from.accel_mps2 + to.accel_mps2)};
  state_ = integrate(*state_, input, to_seconds(to.stamp - now_));
  now_ = to.stamp;
  return true;
}

std::optional<StreamedPose> PoseStream::on_sample(const sync::GroupImu& sample) {
  const std::lock_guard lock(mutex_);
  if (!samples_.empty() && sample.stamp <= samples_.back().stamp) return std::nullopt;
  samples_.push_back(sample);
  if (samples_.size() > config_.most_samples) samples_.pop_front();
  if (!state_ || samples_.size() < 2) return std::nullopt;
  if (sample.stamp - tracked_at_ > config_.longest_carry) {
    state_.reset();
    return std::nullopt;
  }
  if (!step(samples_[samples_.size() - 2], sample) || !state_->is_finite()) return std::nullopt;
  return StreamedPose{sample.stamp, state_->odom_from_body, state_->velocity_in_odom_mps,
                      sample.gyro_radps - state_->gyro_bias_radps, sample.stamp - tracked_at_};
}

}  // namespace edgesplat::tracking
