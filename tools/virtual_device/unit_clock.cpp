// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/unit_clock.hpp"

#include "tools/simulate/noise.hpp"

#include <cmath>

namespace edgesplat::virtual_device {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::int64_t scaled(std::int64_t ns, double ppm) {
  return ns + std::llround(static_cast<double>(ns) * ppm * 1e-6);
}

}  // namespace

UnitClock::UnitClock(const UnitClockConfig& config, std::int64_t switched_on_ns)
    : config_(config), switched_on_ns_(switched_on_ns) {}

double UnitClock::servo_step_ns(std::int64_t step) const {
  simulate::NoiseStream noise(config_.seed, simulate::NoisePurpose::kLidarClock,
                              static_cast<std::uint64_t>(step));
  return config_.servo_sigma_s * 1e9 * noise.gaussian();
}

/// Wanders from one correction to the next, one a second.
double UnitClock::servo_error_ns(std::int64_t true_ns) const {
  const std::int64_t step = true_ns / kSecond_ns;
  const double t = static_cast<double>(true_ns % kSecond_ns) / kSecond_ns;
  return (1.0 - t) * servo_step_ns(step) + t * servo_step_ns(step + 1);
}

UnitSync UnitClock::held_by(std::int64_t true_ns) const {
  if (config_.sync == UnitSync::kPtp) {
    const auto lock_ns = static_cast<std::int64_t>(config_.lock_after_s * kSecond_ns);
    return true_ns - switched_on_ns_ >= lock_ns ? UnitSync::kPtp : UnitSync::kNone;
  }
  if (config_.sync == UnitSync::kPulse && second_error_ns_) return UnitSync::kPulse;
  return UnitSync::kNone;
}

std::int64_t UnitClock::stamp_ns(std::int64_t true_ns) const {
  if (held_by(true_ns) == UnitSync::kNone) return scaled(true_ns - switched_on_ns_, config_.drift_ppm);
  if (lost_at_ns_ && true_ns > *lost_at_ns_)
    return stamp_ns(*lost_at_ns_) + scaled(true_ns - *lost_at_ns_, config_.drift_ppm);
  return master_ns(true_ns) + second_error_ns_.value_or(0) + std::llround(servo_error_ns(true_ns));
}

std::int64_t UnitClock::offset_ns(std::int64_t true_ns) const {
  return held_by(true_ns) == UnitSync::kNone ? 0 : stamp_ns(true_ns) - master_ns(true_ns);
}

void UnitClock::restart(std::int64_t true_ns) {
  switched_on_ns_ = true_ns;
  lost_at_ns_.reset();
  second_error_ns_.reset();
}

void UnitClock::tell_second(std::int64_t true_ns, std::int64_t utc_ns) {
  if (config_.sync != UnitSync::kPulse) return;
  const std::int64_t now_ns = master_ns(true_ns);
  second_error_ns_ = utc_ns - (now_ns - now_ns % kSecond_ns);
}

}  // namespace edgesplat::virtual_device
