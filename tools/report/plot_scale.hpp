// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace edgesplat::report {

/// An interval of data values along an axis.
struct AxisRange {
  double low = 0.0;
  double high = 1.0;
  [[nodiscard]] double length() const { return high - low; }
};

/// The range of all finite values with a margin of 4 %; [0, 1] where there are none, some width where all are
/// equal.
[[nodiscard]] AxisRange range_of(const std::vector<const std::vector<double>*>& values, bool include_zero);

struct Tick {
  double value = 0.0;
  std::string label;
};
/// Round values (1, 2 or 5 times a power of ten) inside the range, about `wanted` of them.
[[nodiscard]] std::vector<Tick> ticks_of(const AxisRange& range, int wanted);

/// At most `limit` indices of a curve: the lowest and highest value of each of limit / 2 equal parts, the
/// first and last value of the curve among them.
[[nodiscard]] std::vector<std::size_t> thin(const std::vector<double>& y, std::size_t limit);

}  // namespace edgesplat::report
