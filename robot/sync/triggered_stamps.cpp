// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/triggered_stamps.hpp"

namespace edgesplat::sync {

void TriggeredStamps::on_pulse(const TriggerPulse& pulse) {
  const std::lock_guard lock(mutex_);
  matcher_.add_pulse(pulse);
}

bool TriggeredStamps::stamp(sensor::CameraFrame& frame) {
  if (frame.stamp_source != sensor::StampSource::kFreeRunning) return true;  // its own clock knows better
  const std::lock_guard lock(mutex_);
  const auto half = from_seconds(0.5 * static_cast<double>(frame.exposure_s));
  const auto pulse = matcher_.match({frame.sequence, frame.stamp - half, frame.arrival});
  if (!pulse) return matcher_.counters().locks == 0;
  frame.stamp = sensor_time_from_ns(to_ns(pulse->time)) + latency_ + half;
  frame.stamp_source = sensor::StampSource::kGps;
  return true;
}

TriggerCounters TriggeredStamps::counters() const {
  const std::lock_guard lock(mutex_);
  return matcher_.counters();
}

}  // namespace edgesplat::sync
