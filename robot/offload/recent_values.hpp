// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <cstddef>
#include <deque>
#include <optional>

namespace edgesplat::offload {

/// The values of the last few seconds, at most 1024 of them (the oldest go first). Pure; single-owner.
class RecentValues {
 public:
  explicit RecentValues(nanoseconds window) : window_(window) {}
  void add(double value, HostTime now);
  /// Nearest rank; nothing where the window is empty.
  [[nodiscard]] std::optional<double> p95(HostTime now);
  [[nodiscard]] std::optional<double> largest(HostTime now);

 private:
  static constexpr std::size_t kMost = 1024;
  struct Value {
    double value;
    HostTime at;
  };
  void forget_old(HostTime now);

  nanoseconds window_;
  std::deque<Value> values_;
};

}  // namespace edgesplat::offload
