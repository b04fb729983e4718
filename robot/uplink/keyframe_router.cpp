// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/keyframe_router.hpp"

namespace edgesplat::uplink {

KeyframeRouter::KeyframeRouter(const RouterConfig& config, HostTime now)
    : config_(config), account_(config.full_bytes_per_s, config.keyframe_bytes, now) {}

void KeyframeRouter::set_mode(link::OffloadMode mode, const LinkLoad& load, HostTime now) {
  if (mode == mode_) return;
  mode_ = mode;
  since_sent_ = 0;
  account_.set_rate(mode == link::OffloadMode::kLean ? config_.lean_bytes_per_s : config_.full_bytes_per_s,
                    load, now);
}

bool KeyframeRouter::mode_sends_next() {
  if (mode_ == link::OffloadMode::kLocal) return false;
  if (mode_ == link::OffloadMode::kFull) return true;
  const bool sends = since_sent_ == 0;
  since_sent_ = (since_sent_ + 1) % config_.lean_every;
  return sends;
}

KeyframeRouter::Way KeyframeRouter::route(bool mode_sends, std::size_t bytes, const LinkLoad& load,
                                          HostTime now) {
  if (!mode_sends) return Way::kKeepMode;
  if (account_.covers(bytes, load, now)) return Way::kSend;
  since_sent_ = 0;  // the next one is tried in its place
  return Way::kKeepBudget;
}

bool KeyframeRouter::may_send_kept(std::size_t bytes, const LinkLoad& load, HostTime now) {
  if (mode_ == link::OffloadMode::kLocal) return false;
  const std::size_t reserve = mode_ == link::OffloadMode::kLean ? config_.lean_reserve_bytes : 0;
  return account_.covers(bytes + reserve, load, now);
}

}  // namespace edgesplat::uplink
