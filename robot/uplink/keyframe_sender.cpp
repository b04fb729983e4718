// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/uplink/keyframe_sender.hpp"

#include "common/log/log.hpp"
#include "common/map/keyframe_codec.hpp"
#include "robot/uplink/slim_keyframe.hpp"

#include <utility>

namespace edgesplat::uplink {
namespace {

/// Any keyframe that FULL makes can be saved up for: slimming misses its target by a little.
RouterConfig with_room_for_a_keyframe(const SenderConfig& config) {
  RouterConfig router = config.router;
  router.keyframe_bytes = config.full_keyframe_bytes + config.full_keyframe_bytes / 8;
  router.lean_reserve_bytes = config.lean_keyframe_bytes;
  return router;
}

}  // namespace

KeyframeSender::KeyframeSender(const SenderConfig& config, link::Transport& transport, const Clock& clock)
    : config_(config),
      transport_(transport),
      clock_(clock),
      router_(with_room_for_a_keyframe(config), clock.now()),
      spool_(config.spool) {}

void KeyframeSender::set_mode(link::OffloadMode mode) {
  const link::OffloadMode before = router_.mode();
  if (mode == before) return;
  if (mode < before) {
    withdraw(link::Lane::kSpool);  // older than the others
    withdraw(link::Lane::kKeyframe);
  }
  router_.set_mode(mode, load(), clock_.now());
}

void KeyframeSender::withdraw(link::Lane lane) {
  for (auto& bytes : transport_.withdraw(lane, config_.robot)) {
    spool_.put(std::move(bytes));
    ++counters_.withdrawn;
  }
}

void KeyframeSender::send(const map::Keyframe& keyframe) {
  const bool mode_sends = router_.mode_sends_next();
  const bool lean = router_.mode() == link::OffloadMode::kLean;
  const std::size_t target = lean ? config_.lean_keyframe_bytes : config_.full_keyframe_bytes;
  auto bytes = map::encode_keyframe(slim_keyframe(keyframe, target));
  if (!bytes) {
    EDGESPLAT_LOG_WARN("uplink", "keyframe refused", "id", keyframe.id.value, "why", bytes.error().context);
    ++counters_.refused;
    return;
  }
  counters_.encoded_bytes += bytes->size();
  switch (router_.route(mode_sends, bytes->size(), load(), clock_.now())) {
    case KeyframeRouter::Way::kSend:
      ++(transport_.send(link::Lane::kKeyframe, config_.robot, *std::move(bytes)) ? counters_.handed_on
                                                                                  : counters_.refused);
      return;
    case KeyframeRouter::Way::kKeepMode:
      ++counters_.kept_by_mode;
      break;
    case KeyframeRouter::Way::kKeepBudget:
      ++counters_.kept_by_budget;
      break;
  }
  spool_.put(*std::move(bytes));
}

void KeyframeSender::send_spooled(bool at_any_cost) {
  const auto size = spool_.next_bytes();
  if (!size || router_.mode() == link::OffloadMode::kLocal || !link_is_idle()) return;
  if (!at_any_cost && !router_.may_send_kept(*size, load(), clock_.now())) return;
  auto bytes = spool_.take();
  if (!bytes) return;
  ++(transport_.send(link::Lane::kSpool, config_.robot, *std::move(bytes)) ? counters_.handed_on
                                                                           : counters_.refused);
}

bool KeyframeSender::link_is_idle() const {
  const link::LinkCounters counters = transport_.counters();
  const auto& keyframes = counters[link::index_of(link::Lane::kKeyframe)];
  const auto& spooled = counters[link::index_of(link::Lane::kSpool)];
  return keyframes.queued_messages + spooled.queued_messages + spooled.flying_messages == 0;
}

LinkLoad KeyframeSender::load() const {
  LinkLoad load;
  for (const link::LaneCounters& lane : transport_.counters()) {
    load.sent_bytes += lane.bytes_sent;
    load.unsent_bytes += lane.unsent_bytes;
  }
  return load;
}

SenderCounters KeyframeSender::counters() const {
  SenderCounters counters = counters_;
  counters.spool = spool_.counters();
  return counters;
}

}  // namespace edgesplat::uplink
