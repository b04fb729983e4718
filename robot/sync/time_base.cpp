// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/time_base.hpp"

namespace edgesplat::sync {
namespace {

constexpr int kStraysForJump = 5;  // one message that hung in the network is no jump of the clock

bool is_disciplined(sensor::StampSource source) {
  return source != sensor::StampSource::kFreeRunning;
}

/// Watches a disciplined clock: messages may be late by a lot, only more than 1 s off is a jump.
ClockMapConfig watching(ClockMapConfig config) {
  config.jump_threshold_s = 1.0;
  return config;
}

}  // namespace

TimeBase::TimeBase(const ClockMapConfig& config) : config_(config) {}

HostTime TimeBase::to_host(Stream stream, SensorTime stamp, HostTime arrival, sensor::StampSource source) {
  if (base_ == Base::kUndecided) base_ = is_disciplined(source) ? Base::kStamps : Base::kArrivals;
  Device& d = device(stream);
  if (d.source != source) change_source(stream, source);
  if (arrival != HostTime{}) {
    if (d.exact) watch_exact(stream, stamp, arrival);
    if (!d.exact) learn(d, stamp, arrival);
  }
  if (d.exact) return host_time_from_ns(to_ns(stamp));
  // One relation for the one clock: the points teach it more often than the IMU does.
  const Device& points = device(Stream::kPoints);
  const bool share = stream == Stream::kImu && points.learnt && !points.exact && points.source == d.source;
  return share ? points.map.to_host(stamp) : d.map.to_host(stamp);
}

bool TimeBase::is_exact(Stream stream) const {
  return device(stream).exact;
}

std::uint64_t TimeBase::clock_changes() const {
  std::uint64_t all = clock_changes_;
  for (const Device& d : devices_)
    if (!d.exact) all += static_cast<std::uint64_t>(d.map.resets());
  return all;
}

void TimeBase::change_source(Stream stream, sensor::StampSource source) {
  Device& d = device(stream);
  if (d.source.has_value()) {
    ++clock_changes_;
    if (!d.exact) clock_changes_ += static_cast<std::uint64_t>(d.map.resets());
  }
  d.source = source;
  d.exact = base_ == Base::kStamps && is_disciplined(source) && !d.jumped;
  d.learnt = false;
  d.map = ClockMap(d.exact ? watching(config_) : config_);
  if (d.exact && !reference_) reference_ = stream;
}

void TimeBase::watch_exact(Stream stream, SensorTime stamp, HostTime arrival) {
  Device& d = device(stream);
  const bool stray = d.learnt && stamp < d.newest - std::chrono::seconds(1);
  d.strays = stray ? d.strays + 1 : 0;
  if (stray && d.strays < kStraysForJump) return;
  d.newest = stamp;
  d.map.observe(stamp, arrival);
  if (d.map.resets() > 0) {
    ++clock_changes_;
    d.exact = false;
    d.jumped = true;
    d.learnt = false;
    d.map = ClockMap(config_);
    return;
  }
  d.learnt = true;
  if (reference_ == stream) arrival_minus_base_ns_ = to_ns(d.map.to_host(stamp)) - to_ns(stamp);
}

void TimeBase::learn(Device& d, SensorTime stamp, HostTime arrival) {
  const bool shift = base_ == Base::kStamps;
  if (shift && !arrival_minus_base_ns_) return;  // no disciplined arrival yet: nothing to relate to
  d.map.observe(stamp, shift ? arrival - nanoseconds(*arrival_minus_base_ns_) : arrival);
  d.learnt = true;
}

}  // namespace edgesplat::sync
