// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock_map.hpp"

#include <cmath>

namespace edgesplat {

ClockMap ClockMap::synchronised() {
  ClockMap map;
  map.synchronised_ = true;
  return map;
}

void ClockMap::reset() {
  hull_.clear();
  slope_ = 0.0;
  ++resets_;
}

void ClockMap::observe(SensorTime stamp, HostTime arrival) {
  if (synchronised_) return;
  const std::int64_t stamp_ns = to_ns(stamp);
  const std::int64_t delay_ns = to_ns(arrival) - stamp_ns;
  const auto jump_ns = static_cast<std::int64_t>(config_.jump_threshold_s * 1e9);
  if (!hull_.empty()) {
    const double predicted =
        static_cast<double>(anchor_delay_ns_) + slope_ * static_cast<double>(stamp_ns - anchor_stamp_ns_);
    const bool earlier_than_possible =
        static_cast<double>(delay_ns) < predicted - static_cast<double>(jump_ns);
    if (earlier_than_possible || stamp_ns < newest_stamp_ns_ - jump_ns) {
      reset();
    } else if (stamp_ns <= newest_stamp_ns_) {
      return;  // reordered on the way: nothing to learn
    }
  }
  newest_stamp_ns_ = stamp_ns;
  // Andrew's monotone chain, newest point last: pop while the middle point lies on or above the chord.
  const Observation next{stamp_ns, delay_ns};
  while (hull_.size() >= 2) {
    const Observation& a = hull_[hull_.size() - 2];
    const Observation& b = hull_.back();
    const double cross =
        static_cast<double>(b.stamp_ns - a.stamp_ns) * static_cast<double>(next.delay_ns - a.delay_ns) -
        static_cast<double>(b.delay_ns - a.delay_ns) * static_cast<double>(next.stamp_ns - a.stamp_ns);
    if (cross > 0) break;
    hull_.pop_back();
  }
  hull_.push_back(next);
  const auto window_ns = static_cast<std::int64_t>(config_.window_s * 1e9);
  while (hull_.size() > 1 && hull_.front().stamp_ns < stamp_ns - window_ns) hull_.pop_front();
  refit();
}

void ClockMap::refit() {
  const double span_ns = static_cast<double>(hull_.back().stamp_ns - hull_.front().stamp_ns);
  anchor_stamp_ns_ = hull_.front().stamp_ns;
  anchor_delay_ns_ = hull_.front().delay_ns;
  slope_ = 0.0;
  if (span_ns < config_.min_span_s * 1e9) {
    for (const Observation& o : hull_) {
      if (o.delay_ns < anchor_delay_ns_) {
        anchor_delay_ns_ = o.delay_ns;
        anchor_stamp_ns_ = o.stamp_ns;
      }
    }
    return;
  }
  // The hull edge over the middle of the window touches the envelope on both sides: the steadiest supporting
  // line.
  const std::int64_t middle_ns =
      hull_.front().stamp_ns + (hull_.back().stamp_ns - hull_.front().stamp_ns) / 2;
  for (std::size_t i = 0; i + 1 < hull_.size(); ++i) {
    if (hull_[i + 1].stamp_ns < middle_ns) continue;
    const double slope = static_cast<double>(hull_[i + 1].delay_ns - hull_[i].delay_ns) /
                         static_cast<double>(hull_[i + 1].stamp_ns - hull_[i].stamp_ns);
    if (std::abs(slope) * 1e6 > config_.max_drift_ppm) break;
    anchor_stamp_ns_ = hull_[i].stamp_ns;
    anchor_delay_ns_ = hull_[i].delay_ns;
    slope_ = slope;
    break;
  }
}

HostTime ClockMap::to_host(SensorTime stamp) const {
  const std::int64_t stamp_ns = to_ns(stamp);
  if (synchronised_ || hull_.empty()) return host_time_from_ns(stamp_ns);
  const double delay_ns = slope_ * static_cast<double>(stamp_ns - anchor_stamp_ns_);
  return host_time_from_ns(stamp_ns + anchor_delay_ns_ + static_cast<std::int64_t>(std::llround(delay_ns)));
}

double ClockMap::drift_ppm() const {
  return -slope_ * 1e6;
}

}  // namespace edgesplat
