// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/trigger_matcher.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::sync {
namespace {

constexpr double kTolerance = 0.2;  // of a period: opto-couplers, crystals, the microcontroller's own clock
constexpr double kMostDrift = 300e-6;  // of the camera's crystal against the pulses
constexpr nanoseconds kReportLag = std::chrono::milliseconds(50);  // a report may come after its frame
constexpr double kKeptPulses_s = 40.0;                             // beyond what frames may lag

}  // namespace

void TriggerMatcher::add_pulse(const TriggerPulse& pulse) {
  if (!pulses_.empty() && pulse.time <= pulses_.back().time) return;
  pulses_.push_back(pulse);
  const nanoseconds keep = from_seconds(config_.most_latency_s + kKeptPulses_s);
  while (pulse.time - pulses_.front().time > keep) pulses_.pop_front();
}

bool TriggerMatcher::is_steps(nanoseconds between, int periods) const {
  const double steps = to_seconds(between) / config_.period_s;
  return std::abs(steps - periods) <= kTolerance;
}

std::optional<TriggerPulse> TriggerMatcher::match(const TriggeredFrame& frame) {
  bool hole = false;
  if (previous_) {
    const std::uint32_t step = frame.number - previous_->number;
    const bool backwards = step == 0 || step > 0x8000'0000U || frame.stamp <= previous_->stamp;
    if (backwards || frame.stamp - previous_->stamp > from_seconds(config_.most_silence_s)) {
      unlock(false);  // the camera began anew, or too long ago
    } else {
      counters_.lost_frames += step - 1;
      hole = step == 1 && is_steps(frame.stamp - previous_->stamp, 2);
    }
  }
  std::optional<TriggerPulse> pulse;
  if (anchor_) pulse = follow(frame);
  if (!anchor_) {
    ++counters_.searching;
    if (hole) look_for_code(frame);
  }
  previous_ = frame;
  return pulse;
}

/// The time of the pulse after the only hole among the pulses that a frame which arrives then can belong to.
std::optional<HostTime> TriggerMatcher::pulse_hole_before(HostTime arrival) const {
  std::optional<HostTime> found;
  for (std::size_t i = 1; i < pulses_.size(); ++i) {
    const TriggerPulse &a = pulses_[i - 1], &b = pulses_[i];
    // Consecutive numbers: a report that got lost is no hole.
    if (b.number - a.number != 1 || !is_steps(b.time - a.time, 2)) continue;
    const nanoseconds late = arrival - b.reported;
    if (late < -kReportLag || late > from_seconds(config_.most_latency_s)) continue;
    if (found) return std::nullopt;  // the code repeats faster than frames may lag
    found = b.time;
  }
  return found;
}

/// Called with the frame after a hole: two periods after the one before, with no frame lost between.
void TriggerMatcher::look_for_code(const TriggeredFrame& frame) {
  const auto pulse_time = pulse_hole_before(frame.arrival);
  if (!pulse_time) {
    candidate_.reset();  // a pulse that the camera missed looks the same
    return;
  }
  const Anchor now{frame.stamp, *pulse_time, pulse_near(*pulse_time)->number, frame.number};
  if (candidate_) {
    const nanoseconds frames = now.stamp - candidate_->stamp,
                      pulses = now.pulse_time - candidate_->pulse_time;
    const double allowed_s = kTolerance * config_.period_s + kMostDrift * to_seconds(pulses);
    if (std::abs(to_seconds(frames - pulses)) <= allowed_s) {
      anchor_ = now;
      candidate_.reset();
      ++counters_.locks;
      return;
    }
  }
  candidate_ = now;
}

const TriggerPulse* TriggerMatcher::pulse_near(HostTime time) const {
  const nanoseconds tolerance = from_seconds(kTolerance * config_.period_s);
  const auto at = std::ranges::lower_bound(pulses_, time - tolerance, {}, &TriggerPulse::time);
  if (at == pulses_.end() || at->time > time + tolerance) return nullptr;
  return &*at;
}

/// The frame's pulse lies as long after the anchor's as their stamps are apart.
std::optional<TriggerPulse> TriggerMatcher::follow(const TriggeredFrame& frame) {
  const TriggerPulse* pulse = pulse_near(anchor_->pulse_time + (frame.stamp - anchor_->stamp));
  if (pulse == nullptr) {
    // Its report got lost or is on its way; but where the pulses have a hole no frame can be.
    const HostTime expected = anchor_->pulse_time + (frame.stamp - anchor_->stamp);
    const auto after = std::ranges::lower_bound(pulses_, expected, {}, &TriggerPulse::time);
    const bool between = after != pulses_.end() && after != pulses_.begin();
    if (between && after->number - std::prev(after)->number == 1) {
      unlock(true);
    } else {
      ++counters_.unmatched;
    }
    return std::nullopt;
  }
  // Both count on over what got lost on the way: more pulses than frames were missed by the camera.
  const std::uint32_t pulses = pulse->number - anchor_->pulse_number;
  const std::uint32_t frames = frame.number - anchor_->frame_number;
  if (pulses > frames) counters_.missed_pulses += pulses - frames;
  anchor_ = Anchor{frame.stamp, pulse->time, pulse->number, frame.number};
  ++counters_.matched;
  return *pulse;
}

void TriggerMatcher::unlock(bool slipped) {
  if (slipped) ++counters_.slips;
  anchor_.reset();
  candidate_.reset();
  previous_.reset();
}

}  // namespace edgesplat::sync
