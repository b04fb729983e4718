// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/ptp_judge.hpp"

#include <cmath>

namespace edgesplat::aravis {
namespace {

constexpr double kLostAt = 10.0;  // times the limit: a servo that was accepted may swing

}  // namespace

void PtpJudge::observe(const PtpReading& reading, HostTime now) {
  const double off_us = std::abs(static_cast<double>(reading.offset_ns.value_or(0))) * 1e-3;
  if (disciplined_) {
    disciplined_ = reading.is_slave() && off_us <= kLostAt * limit_us_;
    if (!disciplined_) good_since_.reset();
    return;
  }
  if (!reading.is_slave() || off_us > limit_us_) {
    good_since_.reset();
    return;
  }
  if (!good_since_) good_since_ = now;
  disciplined_ = now - *good_since_ >= settle_;
}

}  // namespace edgesplat::aravis
