// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"
#include "robot/drivers/livox/endpoint.hpp"

#include <optional>
#include <string>

namespace edgesplat::livox {

/// Notices when the points or the IMU of a LiDAR fall silent, and when both are back. Pure. Single-owner.
class DataWatch {
 public:
  static constexpr nanoseconds kSilentAfter = std::chrono::milliseconds(500);

  explicit DataWatch(bool has_imu) : has_imu_(has_imu) {}

  /// From now on data should come; the very first of each channel may take `patience` (a motor speeds up).
  void expect(HostTime now, nanoseconds patience);
  void on_data(Channel channel, HostTime now);
  /// "points", "IMU" or "points and IMU" at the moment they are found silent; empty else.
  [[nodiscard]] std::string check_silence(HostTime now);
  /// How long it was silent, at the moment everything is back; else nothing.
  [[nodiscard]] std::optional<nanoseconds> check_return();
  [[nodiscard]] bool silent() const { return silent_since_.has_value(); }
  /// Whether points came within the last `age`.
  [[nodiscard]] bool is_fresh(HostTime now, nanoseconds age) const {
    return points_ && now - *points_ <= age;
  }
  /// When check_silence() has to be asked again.
  [[nodiscard]] HostTime next_check() const;

 private:
  [[nodiscard]] HostTime oldest() const;

  bool has_imu_;
  bool expecting_ = false;
  HostTime expected_since_{};
  HostTime grace_until_{};
  std::optional<HostTime> points_;  ///< when the newest came
  std::optional<HostTime> imu_;
  std::optional<HostTime> silent_since_;
};

}  // namespace edgesplat::livox
