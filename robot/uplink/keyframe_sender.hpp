// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/transport.hpp"
#include "common/map/keyframe.hpp"
#include "common/time/clock.hpp"
#include "robot/uplink/keyframe_router.hpp"
#include "robot/uplink/spool.hpp"

#include <cstddef>
#include <cstdint>

namespace edgesplat::uplink {

struct SenderConfig {
  map::RobotId robot{1};                ///< 1..32767
  std::size_t full_keyframe_bytes = 0;  ///< a keyframe is slimmed to about so much in FULL; 0: never
  std::size_t lean_keyframe_bytes = 0;  ///< and in LEAN
  RouterConfig router;
  SpoolConfig spool;
};

struct SenderCounters {
  std::uint64_t refused = 0;       ///< cannot be encoded (not finite, too large), or refused by the transport
  std::uint64_t handed_on = 0;     ///< to the transport; what became of them: Transport::counters()
  std::uint64_t kept_by_mode = 0;  ///< put into the spool since the mode does not send them
  std::uint64_t kept_by_budget = 0;  ///< and since the mode's bytes a second were used up
  std::uint64_t withdrawn = 0;       ///< taken back from the link into the spool when the mode went down
  std::uint64_t encoded_bytes = 0;
  SpoolCounters spool;
};

/// Encodes keyframes and hands them to the link as the mode and its budget say; the others are spooled. When
/// the mode goes down, what the link has not begun is taken back: it was meant for a wider one. Single-owner;
/// the clock may be virtual.
class KeyframeSender {
 public:
  /// `transport` and `clock` must outlive this. Begins in FULL.
  KeyframeSender(const SenderConfig& config, link::Transport& transport, const Clock& clock);

  void set_mode(link::OffloadMode mode);
  void send(const map::Keyframe& keyframe);
  /// The newest spooled one, where the link has nothing else to do and the mode allows it. `at_any_cost`: the
  /// budget of bytes does not hold.
  void send_spooled(bool at_any_cost);

  [[nodiscard]] bool spool_empty() const { return spool_.empty(); }
  [[nodiscard]] SenderCounters counters() const;

 private:
  void withdraw(link::Lane lane);
  [[nodiscard]] bool link_is_idle() const;
  [[nodiscard]] LinkLoad load() const;

  const SenderConfig config_;
  link::Transport& transport_;
  const Clock& clock_;
  KeyframeRouter router_;
  Spool spool_;
  SenderCounters counters_;
};

}  // namespace edgesplat::uplink
