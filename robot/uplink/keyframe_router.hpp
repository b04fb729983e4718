// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/heartbeat.hpp"
#include "robot/uplink/byte_account.hpp"

#include <cstddef>
#include <cstdint>

namespace edgesplat::uplink {

struct RouterConfig {
  double full_bytes_per_s = 0.0;       ///< mean of all that the link sends in FULL; 0: no limit
  double lean_bytes_per_s = 0.0;       ///< and in LEAN
  int lean_every = 3;                  ///< of the keyframes in LEAN one in so many is sent
  std::size_t keyframe_bytes = 0;      ///< the budget may be saved up for one of this size
  std::size_t lean_reserve_bytes = 0;  ///< in LEAN kept ones leave so much for the next that the mode sends
};

/// Says for each keyframe whether it is sent now or kept, by the mode and its budget of bytes. Pure;
/// single-owner.
class KeyframeRouter {
 public:
  enum class Way : std::uint8_t {
    kSend,
    kKeepMode,    ///< the mode does not send it
    kKeepBudget,  ///< the mode's budget is used up
  };

  KeyframeRouter(const RouterConfig& config, HostTime now);
  void set_mode(link::OffloadMode mode, const LinkLoad& load, HostTime now);
  [[nodiscard]] link::OffloadMode mode() const { return mode_; }

  /// A new keyframe, before it is encoded: whether the mode sends it at all.
  [[nodiscard]] bool mode_sends_next();
  /// It has so many bytes.
  [[nodiscard]] Way route(bool mode_sends, std::size_t bytes, const LinkLoad& load, HostTime now);
  /// A kept one may go out now.
  [[nodiscard]] bool may_send_kept(std::size_t bytes, const LinkLoad& load, HostTime now);

 private:
  RouterConfig config_;
  link::OffloadMode mode_ = link::OffloadMode::kFull;
  ByteAccount account_;
  int since_sent_ = 0;  ///< keyframes since the last that LEAN sent
};

}  // namespace edgesplat::uplink
