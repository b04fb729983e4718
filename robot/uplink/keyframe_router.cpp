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
  return account_.covers(bytes, load, now) ? Way::kSend : Way::kKeepBudget;
}

bool KeyframeRouter::may_send_kept(std::size_t bytes, const LinkLoad& load, HostTime now) {
  return mode_ != link::OffloadMode::kLocal && account_.covers(bytes, load, now);
}

}  // namespace edgesplat::uplink
