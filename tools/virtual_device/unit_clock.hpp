// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace edgesplat::virtual_device {

/// What disciplines the clock of a virtual device.
enum class UnitSync : std::uint8_t {
  kNone,   ///< nothing: ns since it was switched on, at its own crystal's rate
  kPtp,    ///< a PTP master
  kPulse,  ///< a pulse a second, at whole seconds of the master's time, and somebody who says which
};

struct UnitClockConfig {
  UnitSync sync = UnitSync::kPtp;
  double drift_ppm = 30.0;      ///< of the crystal, [-1000, 1000]
  double servo_sigma_s = 3e-6;  ///< of the servo that follows a master, [0, 1]
  double lock_after_s = 0.5;    ///< from switching on until a PTP servo holds, [0, 3600]
  std::uint64_t seed = 1;       ///< of the servo's noise
};

/// The clock of a virtual LiDAR: what it would write on a measurement taken at a true time. The master's time
/// is true time, until another epoch or a step is asked for. Times in ns; true times of successive calls may
/// go back a little. Single-owner.
class UnitClock {
 public:
  UnitClock(const UnitClockConfig& config, std::int64_t switched_on_ns);

  [[nodiscard]] UnitSync sync() const { return config_.sync; }
  /// The stamp at `true_ns`.
  [[nodiscard]] std::int64_t stamp_ns(std::int64_t true_ns) const;
  /// What the device says disciplines it, at `true_ns`; kNone while it does not hold yet.
  [[nodiscard]] UnitSync held_by(std::int64_t true_ns) const;
  /// The master's time.
  [[nodiscard]] std::int64_t master_ns(std::int64_t true_ns) const { return true_ns + epoch_ns_ + step_ns_; }
  /// Stamp minus master's time; 0 while nothing disciplines it.
  [[nodiscard]] std::int64_t offset_ns(std::int64_t true_ns) const;

  /// Switched off and on again.
  void restart(std::int64_t true_ns);
  /// The master's time at true time 0.
  void set_epoch(std::int64_t epoch_ns) { epoch_ns_ = epoch_ns; }
  /// kPulse: somebody says that the pulse before `true_ns` was `utc_ns`.
  void tell_second(std::int64_t true_ns, std::int64_t utc_ns);
  /// The master's time jumps, and the device's with it.
  void step_master(std::int64_t by_ns) { step_ns_ += by_ns; }
  /// The master is gone, but the device goes on to say that it is held: from now on it drifts.
  void lose_master(std::int64_t true_ns) { lost_at_ns_ = true_ns; }

 private:
  [[nodiscard]] double servo_error_ns(std::int64_t true_ns) const;
  [[nodiscard]] double servo_step_ns(std::int64_t step) const;

  UnitClockConfig config_;
  std::int64_t switched_on_ns_;
  std::int64_t epoch_ns_ = 0;
  std::int64_t step_ns_ = 0;
  std::optional<std::int64_t> lost_at_ns_;
  std::optional<std::int64_t> second_error_ns_;  ///< kPulse: how wrong the second is that was told
};

}  // namespace edgesplat::virtual_device
