// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock_map.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat {
namespace {

constexpr std::int64_t kBinsPerWindow = 64;

/// a - b and a + b of stamps that come from outside: may wrap, is never undefined.
std::int64_t difference(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}
std::int64_t sum(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

}  // namespace

ClockMap ClockMap::synchronised() {
  ClockMap map;
  map.synchronised_ = true;
  return map;
}

void ClockMap::reset() {
  bins_.clear();
  slope_ = 0.0;
  ++resets_;
}

bool ClockMap::is_jump(const Observation& next) const {
  const double jump_ns = config_.jump_threshold_s * 1e9;
  const double predicted = static_cast<double>(anchor_delay_ns_) +
                           slope_ * static_cast<double>(difference(next.stamp_ns, anchor_stamp_ns_));
  const bool earlier_than_possible = static_cast<double>(next.delay_ns) < predicted - jump_ns;
  const bool went_back = static_cast<double>(difference(next.stamp_ns, newest_stamp_ns_)) < -jump_ns;
  return earlier_than_possible || went_back;
}

void ClockMap::observe(SensorTime stamp, HostTime arrival) {
  if (synchronised_) return;
  const Observation next{to_ns(stamp), difference(to_ns(arrival), to_ns(stamp))};
  if (!bins_.empty()) {
    if (is_jump(next)) {
      reset();
    } else if (next.stamp_ns <= newest_stamp_ns_) {
      return;  // reordered on the way: nothing to learn
    }
  }
  newest_stamp_ns_ = next.stamp_ns;
  keep_least(next);
  refit();
}

void ClockMap::keep_least(const Observation& next) {
  const auto bin_ns = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(config_.window_s * 1e9 / static_cast<double>(kBinsPerWindow)));
  const std::int64_t index = next.stamp_ns / bin_ns;
  if (bins_.empty() || bins_.back().index != index) {
    bins_.push_back({index, next});
  } else if (next.delay_ns <= bins_.back().least.delay_ns) {
    bins_.back().least = next;
  }
  while (bins_.front().index <= index - kBinsPerWindow) bins_.pop_front();
}

void ClockMap::support(double slope) {
  const std::int64_t origin_ns = bins_.back().least.stamp_ns;
  const auto height = [&](const Bin& bin) {  // of the line through this bin, above the origin
    return static_cast<double>(difference(bin.least.delay_ns, bins_.back().least.delay_ns)) -
           slope * static_cast<double>(difference(bin.least.stamp_ns, origin_ns));
  };
  const auto lowest = std::min_element(bins_.begin(), bins_.end(),
                                       [&](const Bin& a, const Bin& b) { return height(a) < height(b); });
  anchor_stamp_ns_ = lowest->least.stamp_ns;
  anchor_delay_ns_ = lowest->least.delay_ns;
  slope_ = slope;
}

void ClockMap::refit() {
  const std::int64_t first_ns = bins_.front().least.stamp_ns;
  const std::int64_t span_ns = difference(bins_.back().least.stamp_ns, first_ns);
  if (static_cast<double>(span_ns) < config_.min_span_s * 1e9) {
    support(0.0);
    return;
  }
  // Andrew's monotone chain: drop the middle point while it lies on or above the chord.
  hull_.clear();
  for (const Bin& bin : bins_) {
    const Observation& c = bin.least;
    while (hull_.size() >= 2) {
      const Observation& a = hull_[hull_.size() - 2];
      const Observation& b = hull_.back();
      const double cross = static_cast<double>(difference(b.stamp_ns, a.stamp_ns)) *
                               static_cast<double>(difference(c.delay_ns, a.delay_ns)) -
                           static_cast<double>(difference(b.delay_ns, a.delay_ns)) *
                               static_cast<double>(difference(c.stamp_ns, a.stamp_ns));
      if (cross > 0) break;
      hull_.pop_back();
    }
    hull_.push_back(c);
  }
  // The edge over the middle of the window touches the envelope on both sides of it: the highest line below
  // all observations there, and the steadiest.
  const std::int64_t middle_ns = sum(first_ns, span_ns / 2);
  std::size_t right = 1;
  while (right + 1 < hull_.size() && hull_[right].stamp_ns < middle_ns) ++right;
  const Observation& a = hull_[right - 1];
  const Observation& b = hull_[right];
  const double slope = static_cast<double>(difference(b.delay_ns, a.delay_ns)) /
                       static_cast<double>(difference(b.stamp_ns, a.stamp_ns));
  const double steepest = config_.max_drift_ppm * 1e-6;
  support(std::clamp(slope, -steepest, steepest));
}

HostTime ClockMap::to_host(SensorTime stamp) const {
  const std::int64_t stamp_ns = to_ns(stamp);
  if (synchronised_ || bins_.empty()) return host_time_from_ns(stamp_ns);
  const double drift_ns = slope_ * static_cast<double>(difference(stamp_ns, anchor_stamp_ns_));
  return host_time_from_ns(sum(sum(stamp_ns, anchor_delay_ns_), std::llround(drift_ns)));
}

double ClockMap::drift_ppm() const {
  return -slope_ * 1e6;
}

}  // namespace edgesplat
