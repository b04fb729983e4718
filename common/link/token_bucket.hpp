// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace edgesplat::link {

/// A rate over time and what of it is unused. Pure; single-owner.
class TokenBucket {
 public:
  /// The rate is bytes_per_s[i] from `start` + at_s[i] on and unlimited before at_s[0].
  TokenBucket(HostTime start, const std::vector<double>& at_s, std::vector<double> bytes_per_s,
              std::size_t burst_bytes);

  /// Nothing: unlimited at that time.
  [[nodiscard]] std::optional<double> rate_at(HostTime t) const;
  /// When `bytes` may pass, if nothing else does before; `now` or later, HostTime::max() for never.
  [[nodiscard]] HostTime ready_at(std::size_t bytes, HostTime now) const;
  /// `bytes` pass at `t`; leaves a debt where they were not ready. `head_bytes`: what waits first in line has
  /// this size, so that as much may be saved up for it.
  void take(std::size_t bytes, HostTime t, std::size_t head_bytes = 0);

 private:
  /// Tokens at `t` where nothing passes meanwhile and up to `most` are saved.
  [[nodiscard]] double tokens_at(HostTime t, double most) const;
  [[nodiscard]] double passed_between(HostTime from, HostTime to) const;

  std::vector<HostTime> changes_;
  std::vector<double> bytes_per_s_;
  double burst_bytes_;
  double tokens_;
  HostTime counted_{};
};

}  // namespace edgesplat::link
