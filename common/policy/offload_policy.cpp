// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/policy/offload_policy.hpp"

#include <algorithm>

namespace edgesplat::policy {

std::string_view to_string(Mode mode) {
  switch (mode) {
    case Mode::kLocal:
      return "LOCAL";
    case Mode::kLean:
      return "LEAN";
    case Mode::kFull:
      return "FULL";
  }
  return "unknown";
}

std::string_view to_string(Reason reason) {
  switch (reason) {
    case Reason::kNone:
      return "none";
    case Reason::kLatency:
      return "latency";
    case Reason::kMemory:
      return "memory";
    case Reason::kSetting:
      return "setting";
    case Reason::kBandwidth:
      return "bandwidth";
    case Reason::kRoundTrip:
      return "round_trip";
    case Reason::kServerLost:
      return "server_lost";
    case Reason::kFailed:
      return "failed";
  }
  return "unknown";
}

bool OffloadPolicy::server_alive(const Situation& s) const {
  return s.last_heartbeat && s.now - *s.last_heartbeat <= from_seconds(config_.server_timeout_s);
}

Reason OffloadPolicy::overload(const Situation& s) const {
  if (s.render_p95_ms && *s.render_p95_ms > config_.latency_threshold_ms) return Reason::kLatency;
  if (s.memory_peak_bytes && *s.memory_peak_bytes > config_.memory_threshold_bytes) return Reason::kMemory;
  return Reason::kNone;
}

Reason OffloadPolicy::load_trigger(const Situation& s) const {
  return config_.setting == OffloadSetting::kAlways ? Reason::kSetting : overload(s);
}

Mode OffloadPolicy::link_allows(const Situation& s, double factor, double round_trip_factor) const {
  if (!s.bandwidth_bytes_per_s) return Mode::kLocal;
  if (s.round_trip_ms && *s.round_trip_ms > round_trip_factor * config_.round_trip_threshold_ms)
    return Mode::kLocal;
  if (*s.bandwidth_bytes_per_s >= factor * config_.full_bandwidth_bytes_per_s) return Mode::kFull;
  if (*s.bandwidth_bytes_per_s >= factor * config_.lean_bandwidth_bytes_per_s) return Mode::kLean;
  return Mode::kLocal;
}

void OffloadPolicy::switch_to(Mode mode, Reason reason, HostTime now) {
  decision_.mode = mode;
  decision_.reason = reason;
  decision_.changed = true;
  switches_.push_back(now);
  if (switches_.size() > 2) switches_.pop_front();
  downgrade_windows_ = 0;
  upgrade_windows_ = 0;
}

bool OffloadPolicy::upgrade_is_due(HostTime now) const {
  if (blocked_until_ && now < *blocked_until_) return false;
  const nanoseconds interval = from_seconds(config_.switch_interval_s);
  if (!switches_.empty() && now - switches_.back() < interval) return false;
  return switches_.size() < 2 || now - switches_.front() >= 2 * interval;
}

void OffloadPolicy::consider_downgrade(const Situation& s) {
  if (decision_.mode == Mode::kLocal) return;
  if (!server_alive(s)) return switch_to(Mode::kLocal, Reason::kServerLost, s.now);
  if (s.offload_failed) {
    backoff_s_ = std::clamp(2.0 * backoff_s_, config_.backoff_first_s, config_.backoff_most_s);
    blocked_until_ = s.now + from_seconds(backoff_s_);
    return switch_to(Mode::kLocal, Reason::kFailed, s.now);
  }
  const Mode allowed = link_allows(s, config_.leave_factor, config_.round_trip_leave_factor);
  downgrade_windows_ = allowed < decision_.mode ? downgrade_windows_ + 1 : 0;
  if (downgrade_windows_ < config_.windows_in_a_row) return;
  const bool slow =
      s.round_trip_ms && *s.round_trip_ms > config_.round_trip_leave_factor * config_.round_trip_threshold_ms;
  switch_to(allowed, slow ? Reason::kRoundTrip : Reason::kBandwidth, s.now);
}

void OffloadPolicy::consider_upgrade(const Situation& s) {
  const Reason load = load_trigger(s);
  // Once offloaded the load is the server's: only the link decides between LEAN and FULL.
  const bool wanted = decision_.mode != Mode::kLocal || load != Reason::kNone;
  const Mode allowed = server_alive(s) && s.in_step && !s.offload_failed
                           ? link_allows(s, config_.enter_factor, 1.0)
                           : Mode::kLocal;
  upgrade_windows_ = wanted && allowed > decision_.mode ? upgrade_windows_ + 1 : 0;
  if (decision_.mode == Mode::kLocal)
    decision_.prune_and_compress = overload(s) != Reason::kNone && allowed == Mode::kLocal;
  if (upgrade_windows_ < config_.windows_in_a_row || !upgrade_is_due(s.now)) return;
  switch_to(allowed, decision_.mode == Mode::kLocal ? load : Reason::kBandwidth, s.now);
  decision_.prune_and_compress = false;
}

bool OffloadPolicy::wants_offload(const Situation& s) const {
  if (config_.setting == OffloadSetting::kNever) return false;
  return decision_.mode != Mode::kLocal || load_trigger(s) != Reason::kNone;
}

bool OffloadPolicy::bandwidth_matters(const Situation& s) const {
  return wants_offload(s) && decision_.mode != Mode::kFull && server_alive(s);
}

Decision OffloadPolicy::evaluate(const Situation& s) {
  decision_.changed = false;
  if (last_evaluation_ && s.now - *last_evaluation_ < from_seconds(config_.evaluation_period_s))
    return decision_;
  last_evaluation_ = s.now;
  if (config_.setting == OffloadSetting::kNever) {
    decision_.prune_and_compress = overload(s) != Reason::kNone;
    return decision_;
  }
  if (decision_.mode != Mode::kLocal && !switches_.empty() &&
      s.now - switches_.back() > from_seconds(config_.backoff_most_s)) {
    backoff_s_ = 0.0;  // a long good spell: the next failure starts small again
  }
  consider_downgrade(s);
  if (!decision_.changed) consider_upgrade(s);
  return decision_;
}

}  // namespace edgesplat::policy
