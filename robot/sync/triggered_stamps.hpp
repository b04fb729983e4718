// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "robot/sync/trigger_matcher.hpp"

#include <cstdint>
#include <mutex>

namespace edgesplat::sync {

/// Frames of a camera with a free clock get the time of the pulse that made them: the pulse's edge, the
/// input's latency and half the exposure. Until the gap code was found frames pass as they are; from then on
/// one whose pulse is not certain is dropped, as a wrong time does more harm than a missing picture. Pulses
/// and frames may come from two threads.
class TriggeredStamps {
 public:
  TriggeredStamps(const TriggerMatcherConfig& config, double input_latency_s)
      : latency_(from_seconds(input_latency_s)), matcher_(config) {}

  void on_pulse(const TriggerPulse& pulse);
  /// False: not to be used.
  [[nodiscard]] bool stamp(sensor::CameraFrame& frame);
  [[nodiscard]] TriggerCounters counters() const;

 private:
  nanoseconds latency_;
  mutable std::mutex mutex_;
  TriggerMatcher matcher_;
};

}  // namespace edgesplat::sync
