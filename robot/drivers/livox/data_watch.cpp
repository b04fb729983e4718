// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/data_watch.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::livox {
namespace {

/// The two channels of a LiDAR that was pulled end some packets apart: one event, not two.
constexpr nanoseconds kSilentToo = DataWatch::kSilentAfter / 2;

}  // namespace

void DataWatch::expect(HostTime now, nanoseconds patience) {
  if (std::exchange(expecting_, true)) return;
  expected_since_ = now;
  grace_until_ = now + patience;
  if (!points_) points_ = now;
  if (!imu_) imu_ = now;
}

void DataWatch::on_data(Channel channel, HostTime now) {
  if (channel == Channel::kPoints) points_ = now;
  if (channel == Channel::kImu) imu_ = now;
}

HostTime DataWatch::oldest() const {
  return has_imu_ ? std::min(*points_, *imu_) : *points_;
}

std::string DataWatch::check_silence(HostTime now) {
  if (!expecting_ || silent_since_ || now < next_check()) return {};
  silent_since_ = oldest();
  const bool points_silent = now - *points_ > kSilentToo;
  const bool imu_silent = has_imu_ && now - *imu_ > kSilentToo;
  if (!points_silent) return "IMU";
  return imu_silent ? "points and IMU" : "points";
}

std::optional<nanoseconds> DataWatch::check_return() {
  if (!silent_since_ || oldest() <= *silent_since_ + kSilentToo) return std::nullopt;
  const nanoseconds silence = oldest() - *silent_since_;
  silent_since_.reset();
  return silence;
}

HostTime DataWatch::next_check() const {
  if (!expecting_ || silent_since_) return HostTime::max();
  const HostTime check = oldest() + kSilentAfter;
  return oldest() > expected_since_ ? check : std::max(check, grace_until_);
}

}  // namespace edgesplat::livox
