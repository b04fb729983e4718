// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <algorithm>
#include <cstddef>

namespace edgesplat::stream {

/// How much may be sent now so that the mean stays under a rate: fills up evenly, holds at most a burst.
/// Spending beyond it is allowed and paid back before anything is available again. Single-owner.
class ByteAllowance {
 public:
  /// Starts full.
  ByteAllowance(double bytes_per_s, double burst_s, HostTime now)
      : bytes_per_s_(bytes_per_s), burst_(bytes_per_s * burst_s), bytes_(burst_), at_(now) {}

  [[nodiscard]] std::size_t available(HostTime now) {
    bytes_ = std::min(burst_, bytes_ + bytes_per_s_ * to_seconds(now - at_));
    at_ = now;
    return bytes_ > 0.0 ? static_cast<std::size_t>(bytes_) : 0;
  }
  void spend(std::size_t bytes) { bytes_ -= static_cast<double>(bytes); }

 private:
  double bytes_per_s_;
  double burst_;
  double bytes_;
  HostTime at_;
};

}  // namespace edgesplat::stream
