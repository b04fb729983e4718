// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/time_base.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::sync {
namespace {

constexpr double kSpan_ns = 5e9;                  // long enough to see about the least latency
constexpr double kSameTime_ns = 5.5e9;            // ends of spans of two devices that both are heard
constexpr double kScatterShare = 0.5;             // of mean lateness: the least of a span may be this far off
constexpr std::int64_t kFarOff_ns = 500'000'000;  // more than any network delays a packet
constexpr nanoseconds kReferencePatience = std::chrono::seconds(2);
constexpr int kStraysForJump = 5;  // one message that hung in the network is no jump of the clock

/// Of numbers that come from outside: may wrap, is never undefined.
std::int64_t difference(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

bool is_disciplined(sensor::StampSource source) {
  return source != sensor::StampSource::kFreeRunning;
}

}  // namespace

TimeBase::TimeBase(const ClockMapConfig& config, double disagree_limit_s, bool imu_has_own_clock,
                   std::size_t lidars)
    : config_(config),
      disagree_limit_ns_(disagree_limit_s * 1e9),
      imu_has_own_clock_(imu_has_own_clock),
      has_several_lidars_(lidars > 1) {}

/// How a disciplined clock is watched: messages may be late by a lot, only more than 1 s off is a jump. A
/// LiDAR's packets are not late, and a step ahead of one of several must not pass the others by.
ClockMapConfig TimeBase::watching(Stream stream) const {
  ClockMapConfig config = config_;
  if (!has_several_lidars_ || !is_lidar(stream)) config.jump_threshold_s = 1.0;
  return config;
}

/// The first that is heard of a LiDAR's disciplined clock is another time than the other clocks'.
bool TimeBase::is_far_off(Stream stream, SensorTime stamp, HostTime arrival) const {
  if (!has_several_lidars_ || !is_lidar(stream) || device(stream).learnt || !arrival_minus_base_ns_)
    return false;
  const std::int64_t off_ns = difference(difference(to_ns(arrival), to_ns(stamp)), *arrival_minus_base_ns_);
  return off_ns > kFarOff_ns || off_ns < -kFarOff_ns;
}

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
  const bool share = stream == Stream::kImu && !imu_has_own_clock_ && points.learnt && !points.exact &&
                     points.source == d.source;
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
  d.least = {};
  d.map = ClockMap(d.exact ? watching(stream) : config_);
  if (d.exact && !reference_) reference_ = stream;
}

void TimeBase::watch_exact(Stream stream, SensorTime stamp, HostTime arrival) {
  Device& d = device(stream);
  const bool stray = d.learnt && stamp < d.newest - std::chrono::seconds(1);
  d.strays = stray ? d.strays + 1 : 0;
  if (stray && d.strays < kStraysForJump) return;
  if (reference_ != stream && is_far_off(stream, stamp, arrival)) {
    ++lies_;
    fit_from_now(d, 0);
    return;
  }
  observe(d, stamp, arrival);
  if (d.map.resets() > 0) {
    fit_from_now(d, 0);
    return;
  }
  // One that fell silent says nothing of the host's clock any more.
  if (has_several_lidars_ && is_lidar(stream) && reference_ != stream &&
      arrival - device(*reference_).heard > kReferencePatience)
    refer_to(stream);
  if (reference_ == stream) {
    arrival_minus_base_ns_ = offset_ns(d);
    look_for_lies();
  }
}

/// A disciplined clock that cannot be believed: what is exact from here on is the others.
void TimeBase::fit_from_now(Device& d, std::int64_t latency_ns) {
  ++clock_changes_;
  d.exact = false;
  d.jumped = true;
  d.learnt = false;
  d.least = {};
  d.latency_ns = latency_ns;
  d.map = ClockMap(config_);
  if (reference_ && !device(*reference_).exact) {
    for (std::size_t i = 0; i < kStreams; ++i)
      if (devices_[i].exact && devices_[i].learnt) refer_to(static_cast<Stream>(i));
  }
}

std::int64_t TimeBase::offset_ns(const Device& d) {
  return difference(to_ns(d.map.to_host(d.newest)), to_ns(d.newest));
}

/// What was compared with another reference means nothing any more.
void TimeBase::refer_to(Stream stream) {
  reference_ = stream;
  for (Device& d : devices_) d.compared.reset();
}

/// How far both have moved against the host's clock since they were first compared. Only what was measured at
/// the same time compares: the host's clock drifts as well.
std::optional<TimeBase::Moved> TimeBase::compare(Device& d, const Device& reference) {
  if (!d.exact || !d.least.newest_ns) {
    d.compared.reset();
    return std::nullopt;
  }
  const auto apart_ns =
      static_cast<double>(difference(to_ns(d.least.newest_end), to_ns(reference.least.newest_end)));
  if (std::abs(apart_ns) > kSameTime_ns) return std::nullopt;
  if (!d.compared) d.compared = Compared{*d.least.newest_ns, *reference.least.newest_ns};
  return Moved{static_cast<double>(difference(*d.least.newest_ns, d.compared->own_ns)),
               static_cast<double>(difference(*reference.least.newest_ns, d.compared->reference_ns))};
}

void TimeBase::look_for_lies() {
  Device& reference = device(*reference_);
  if (!reference.least.newest_ns) {
    for (Device& d : devices_) d.compared.reset();
    return;
  }
  for (Device& d : devices_) {
    if (&d == &reference) continue;
    const auto moved = compare(d, reference);
    const double scatter_ns = 1e9 * kScatterShare * std::max(d.jitter_s, reference.jitter_s);
    if (!moved || std::abs(moved->own_ns - moved->reference_ns) <= std::max(disagree_limit_ns_, scatter_ns))
      continue;
    ++lies_;
    // While both could be believed their stamps told how much longer its messages are on the way.
    const std::int64_t longer_ns = difference(d.compared->own_ns, d.compared->reference_ns);
    if (std::abs(moved->own_ns) <= std::abs(moved->reference_ns)) {
      fit_from_now(reference, -longer_ns);
    } else {
      fit_from_now(d, longer_ns);
    }
    return;
  }
}

void TimeBase::observe(Device& d, SensorTime stamp, HostTime arrival) {
  const std::int64_t resets = d.map.resets();
  d.map.observe(stamp, arrival);
  d.least.observe(stamp, difference(to_ns(arrival), to_ns(stamp)), !d.learnt || d.map.resets() != resets);
  d.newest = stamp;
  d.heard = arrival;
  d.learnt = true;
  const double late_s = 1e-9 * static_cast<double>(difference(to_ns(arrival), to_ns(d.map.to_host(stamp))));
  constexpr double kSmoothing = 0.02;
  d.jitter_s += kSmoothing * (std::clamp(late_s, 0.0, 1.0) - d.jitter_s);
}

double TimeBase::LeastDelay::drift_ppm() const {
  const auto passed_ns = static_cast<double>(difference(to_ns(newest_end), to_ns(first_end)));
  if (!newest_ns || passed_ns <= 0.0) return 0.0;
  return -1e6 * static_cast<double>(difference(*newest_ns, *first_ns)) / passed_ns;
}

void TimeBase::LeastDelay::observe(SensorTime stamp, std::int64_t delay_ns, bool restart) {
  if (restart) *this = {stamp, delay_ns, std::nullopt, std::nullopt, {}, {}};
  const auto passed_ns = static_cast<double>(difference(to_ns(stamp), to_ns(began)));
  if (passed_ns > 2.0 * kSpan_ns) {  // it was silent: what was before says nothing of now
    began = stamp;
    running_ns = delay_ns;
  }
  running_ns = std::min(running_ns, delay_ns);
  if (passed_ns < kSpan_ns || began == stamp) return;
  if (!first_ns) {
    first_ns = running_ns;
    first_end = stamp;
  }
  newest_ns = running_ns;
  newest_end = stamp;
  began = stamp;
  running_ns = delay_ns;
}

std::optional<TimeBase::ClockState> TimeBase::clock_state(Stream stream) const {
  const Device& d = device(stream);
  if (!d.learnt) return std::nullopt;
  std::int64_t offset = offset_ns(d);
  if (d.exact && arrival_minus_base_ns_) offset = difference(offset, *arrival_minus_base_ns_);
  return ClockState{d.exact, static_cast<double>(offset) * 1e-9, d.least.drift_ppm(), d.jitter_s};
}

void TimeBase::learn(Device& d, SensorTime stamp, HostTime arrival) {
  const bool shift = base_ == Base::kStamps;
  if (shift && !arrival_minus_base_ns_) return;  // no disciplined arrival yet: nothing to relate to
  observe(d, stamp,
          shift ? arrival - nanoseconds(*arrival_minus_base_ns_) - nanoseconds(d.latency_ns) : arrival);
}

}  // namespace edgesplat::sync
