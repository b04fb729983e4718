// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <cstdint>
#include <deque>
#include <optional>

namespace edgesplat::sync {

/// A pulse on the trigger line, as the microcontroller that made it reports it.
struct TriggerPulse {
  std::uint32_t number = 0;  ///< +1 a pulse; pulses that are left out for the gap code have none
  HostTime time{};           ///< of its edge on the PPS' time line: second + phase
  HostTime reported{};       ///< when the report came, on the host's clock
};

/// A frame of a camera whose clock is not disciplined.
struct TriggeredFrame {
  std::uint32_t number = 0;  ///< +1 a frame that the camera made
  SensorTime stamp{};        ///< of the exposure's beginning, the camera's own clock
  HostTime arrival{};        ///< on the host's clock: after the pulse by exposure, readout and transfer
};

struct TriggerMatcherConfig {
  double period_s = 0.1;         ///< between pulses, (0, 10]
  double most_latency_s = 1.0;   ///< a frame arrives at most this long after its pulse, [0.01, 10]
  double most_silence_s = 60.0;  ///< after a longer pause the gap code is looked for anew
};

struct TriggerCounters {
  std::uint64_t matched = 0;
  std::uint64_t searching = 0;      ///< frames while it was not known which pulse belongs to them: not used
  std::uint64_t lost_frames = 0;    ///< holes in the frames' numbers
  std::uint64_t missed_pulses = 0;  ///< pulses of which the camera made no frame
  std::uint64_t unmatched = 0;      ///< frames for which no pulse was reported: not used
  std::uint64_t slips = 0;          ///< the code did not come where it should: looked for anew
  std::uint64_t locks = 0;
};

/// Which pulse made which frame. Counting alone would shift all frames after one that got lost; arrival times
/// alone do when a frame is later than a period. So the pulses carry a code: one is left out every few
/// seconds. In the camera's stamps the same hole shows, whatever got lost on the way, and fixes which frame
/// is which; from then on each frame follows from the last by the time between their stamps, and each hole
/// proves that it still is so. A frame is only given a pulse when that is certain. Thread-bound; memory for
/// `most_latency_s` and some seconds.
class TriggerMatcher {
 public:
  explicit TriggerMatcher(const TriggerMatcherConfig& config) : config_(config) {}

  /// In the order of their numbers; a report that got lost is borne.
  void add_pulse(const TriggerPulse& pulse);
  /// The pulse that made this frame, once its report has come; nothing where it is not certain. Frames in
  /// order.
  [[nodiscard]] std::optional<TriggerPulse> match(const TriggeredFrame& frame);
  [[nodiscard]] bool locked() const { return anchor_.has_value(); }
  [[nodiscard]] const TriggerCounters& counters() const { return counters_; }

 private:
  /// A frame whose pulse is known: the stamps of others are measured from here.
  struct Anchor {
    SensorTime stamp;
    HostTime pulse_time;
    std::uint32_t pulse_number;
    std::uint32_t frame_number;
  };
  [[nodiscard]] bool is_steps(nanoseconds between, int periods) const;
  [[nodiscard]] std::optional<HostTime> pulse_hole_before(HostTime arrival) const;
  void look_for_code(const TriggeredFrame& frame);
  [[nodiscard]] std::optional<TriggerPulse> follow(const TriggeredFrame& frame);
  [[nodiscard]] const TriggerPulse* pulse_near(HostTime time) const;
  void unlock(bool slipped);

  TriggerMatcherConfig config_;
  std::deque<TriggerPulse> pulses_;
  std::optional<TriggeredFrame> previous_;
  std::optional<Anchor> candidate_;  ///< from one hole; a second one that agrees makes it the anchor
  std::optional<Anchor> anchor_;
  TriggerCounters counters_;
};

}  // namespace edgesplat::sync
