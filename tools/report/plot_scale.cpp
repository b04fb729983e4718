// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/plot_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace edgesplat::report {

AxisRange range_of(const std::vector<const std::vector<double>*>& values, bool include_zero) {
  AxisRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const auto* list : values) {
    for (const double value : *list) {
      if (!std::isfinite(value)) continue;
      range.low = std::min(range.low, value);
      range.high = std::max(range.high, value);
    }
  }
  if (range.low > range.high) return {0.0, 1.0};
  const bool zero_is_low = include_zero && range.low >= 0.0;
  if (include_zero) range = {std::min(range.low, 0.0), std::max(range.high, 0.0)};
  if (range.length() <= 1e-12 * std::max(std::abs(range.low), std::abs(range.high)) ||
      range.length() == 0.0) {
    const double half = range.high == 0.0 ? 0.5 : 0.1 * std::abs(range.high);
    return {zero_is_low ? 0.0 : range.low - half, range.high + half};
  }
  const double margin = 0.04 * range.length();
  return {zero_is_low ? 0.0 : range.low - margin, range.high + margin};
}

std::vector<Tick> ticks_of(const AxisRange& range, int wanted) {
  const double raw_step = range.length() / std::max(wanted, 1);
  if (!(raw_step > 0.0) || !std::isfinite(raw_step)) return {};
  const double power = std::pow(10.0, std::floor(std::log10(raw_step)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw_step) {
      step = factor * power;
      break;
    }
  }
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  const bool in_thousands = std::max(std::abs(range.low), std::abs(range.high)) >= 1e4;
  std::vector<Tick> ticks;
  const double first = std::ceil(range.low / step - 1e-9);
  const double last = std::floor(range.high / step + 1e-9);
  for (double n = first; n <= last; n += 1.0) {
    const double value = n == 0.0 ? 0.0 : n * step;  // no "-0"
    ticks.push_back({value, in_thousands && value != 0.0 ? fmt::format("{:g}k", value / 1e3)
                                                         : fmt::format("{:.{}f}", value, decimals)});
  }
  return ticks;
}

std::vector<std::size_t> thin(const std::vector<double>& y, std::size_t limit) {
  std::vector<std::size_t> kept;
  if (y.size() <= limit) {
    kept.resize(y.size());
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  const std::size_t parts = std::max<std::size_t>(limit / 2, 1);
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = part * y.size() / parts;
    const std::size_t end = (part + 1) * y.size() / parts;
    std::size_t lowest = begin;
    std::size_t highest = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (!(y[i] >= y[lowest])) lowest = i;  // so that a NaN, which breaks the line, is kept
      if (y[i] > y[highest]) highest = i;
    }
    kept.push_back(std::min(lowest, highest));
    if (lowest != highest) kept.push_back(std::max(lowest, highest));
  }
  kept.front() = 0;
  kept.back() = y.size() - 1;
  return kept;
}

}  // namespace edgesplat::report
