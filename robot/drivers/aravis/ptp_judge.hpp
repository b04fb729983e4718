// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"
#include "robot/drivers/aravis/camera_setup.hpp"

#include <optional>

namespace edgesplat::aravis {

/// When a camera's clock counts as disciplined: a slave closer to its master than the limit for the settle
/// time, until it is no slave any more or ten times as far off. Single-owner.
class PtpJudge {
 public:
  PtpJudge(double offset_limit_us, double settle_s)
      : limit_us_(offset_limit_us), settle_(from_seconds(settle_s)) {}

  void observe(const PtpReading& reading, HostTime now);
  [[nodiscard]] bool disciplined() const { return disciplined_; }

 private:
  double limit_us_;
  nanoseconds settle_;
  std::optional<HostTime> good_since_;
  bool disciplined_ = false;
};

}  // namespace edgesplat::aravis
