// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/lidar_session.hpp"

#include <algorithm>
#include <cstdio>

namespace edgesplat::livox {
namespace {

constexpr std::size_t kForeignRemembered = 16;
constexpr nanoseconds kLongestPause = std::chrono::milliseconds(100);  // data that come move deadlines
constexpr nanoseconds kNobodyAfter = std::chrono::seconds(5);
constexpr nanoseconds kFirstDataPatience = std::chrono::seconds(2);
constexpr nanoseconds kFirstRearmPause = std::chrono::seconds(1);
constexpr nanoseconds kLongestRearmPause = std::chrono::seconds(30);

std::string seconds_text(nanoseconds duration) {
  std::array<char, 32> text{};
  (void)std::snprintf(text.data(), text.size(), "%.2f s", to_seconds(duration));
  return text.data();
}

/// SDK1 announces the serial number and one character more: both may be configured.
bool is_named(const std::string& serial_number, const std::string& name) {
  constexpr std::size_t kSerialLength = 14;
  return serial_number.starts_with(name) &&
         serial_number.size() - name.size() <= std::size_t{name.size() == kSerialLength};
}

}  // namespace

const LidarEventName& name_of(LidarEventKind kind) {
  static constexpr std::array<LidarEventName, kLidarEventKinds> kNames{{
      {"LiDAR found", "found", false},
      {"LiDAR measures", "starts", false},
      {"LiDAR fell silent", "silences", true},
      {"LiDAR data are back", "recoveries", false},
      {"LiDAR does not answer", "unreachable", true},
      {"LiDAR has another address", "moves", true},
      {"LiDAR refused a setting", "refusals", true},
      {"LiDAR has no firmware", "no_firmware", true},
      {"another LiDAR is on the wire", "foreign_units", true},
      {"LiDAR clock", "sync_changes", true},
      {"LiDAR reports a fault", "faults", true},
      {"LiDAR clock started anew", "clock_restarts", true},
  }};
  return kNames.at(static_cast<std::size_t>(kind));
}

void LidarSession::on_data(Channel channel, HostTime now) {
  watch_.on_data(channel, now);
  if (const auto silence = watch_.check_return())
    tell(LidarEventKind::kRecovered, "after " + seconds_text(*silence));
}

HostTime LidarSession::step(HostTime now) {
  if (const std::string silent = watch_.check_silence(now); !silent.empty()) {
    tell(LidarEventKind::kSilent, silent);
    on_silence(now);
  }
  const bool feeds = config_.feeds_utc && is_sampling();
  if (!feeds) {
    utc_feed_.skip();
  } else if (const auto utc_ns = utc_feed_.due(now)) {
    send_utc(*utc_ns);
    ++counters_.utc_told;
  }
  step_pending(now);
  if (is_searching() && now >= next_search_) {
    next_search_ = now + pace_.search_period;
    note_nobody(now);
    search(now);
  }
  HostTime next = std::min(step_protocol(now), watch_.next_check());
  if (waits_for_data() && now >= next_rearm_) on_silence(now);
  next = std::min(next, pending_.next_due());
  if (is_searching()) next = std::min(next, next_search_);
  if (waits_for_data()) next = std::min(next, next_rearm_);
  if (feeds) next = std::min(next, utc_feed_.next_due());
  return std::min(next, now + kLongestPause);
}

void LidarSession::step_pending(HostTime now) {
  switch (pending_.due(now)) {
    case PendingRequest::Due::kRepeat:
      ++counters_.retries;
      send(pending_.to(), pending_.bytes());
      break;
    case PendingRequest::Due::kGiveUp:
      note_unreachable(unit_->serial_number + " at " + to_string(unit_->at.ip));
      search_from(now + pace_.pause_after_all);
      break;
    case PendingRequest::Due::kNothing:
      break;
  }
}

/// The longer it stays silent the more seldom it is brought up again.
void LidarSession::on_silence(HostTime now) {
  rearm_pause_ = std::min(2 * rearm_pause_, kLongestRearmPause);
  bring_up_again(now);
}

void LidarSession::search_from(HostTime when) {
  become_searching();
  pending_.forget();
  next_search_ = when;
}

void LidarSession::ask(std::uint32_t sequence, std::vector<std::byte> bytes, HostTime now) {
  pending_.begin(unit_->at, sequence, bytes, now);
  send(unit_->at, std::move(bytes));
}

void LidarSession::send(const Endpoint& to, std::vector<std::byte> bytes) {
  ++counters_.requests;
  outgoing_.push_back({to, std::move(bytes)});
}

void LidarSession::tell(LidarEventKind kind, std::string detail) {
  ++counters_.events.at(static_cast<std::size_t>(kind));
  events_.push_back({kind, std::move(detail)});
}

bool LidarSession::is_wanted(const std::string& serial_number, const Ipv4& ip) {
  const bool is_known = unit_ && !unit_->serial_number.empty();
  const bool wanted = config_.serial_number.empty() ? (!config_.address || ip == *config_.address) &&
                                                          (!is_known || unit_->serial_number == serial_number)
                                                    : is_named(serial_number, config_.serial_number);
  const bool is_neighbour = std::ranges::any_of(config_.neighbours, [&](const std::string& name) {
    return is_named(serial_number, name) || name == to_string(ip);
  });
  if (wanted || is_neighbour) return wanted;
  const bool told = std::find(foreign_.begin(), foreign_.end(), serial_number) != foreign_.end();
  if (!told && foreign_.size() < kForeignRemembered) {
    foreign_.push_back(serial_number);
    tell(LidarEventKind::kForeign, serial_number + " at " + to_string(ip) + ", left alone");
  }
  return false;
}

void LidarSession::meet(const std::string& serial_number, const Endpoint& at) {
  if (unit_ && unit_->at.ip != at.ip)
    tell(LidarEventKind::kMoved,
         serial_number + " from " + to_string(unit_->at.ip) + " to " + to_string(at.ip));
  note_heard();
  unit_ = Unit{serial_number, at};
}

void LidarSession::note_sync(std::string sync) {
  if (sync == health_.sync) return;
  const bool first = health_.sync == "unknown";
  if (!first) tell(LidarEventKind::kSyncChanged, health_.sync + " -> " + sync);
  health_.sync = std::move(sync);
}

void LidarSession::note_unreachable(const std::string& why) {
  if (std::exchange(unreachable_, true)) return;
  tell(LidarEventKind::kUnreachable, why);
}

void LidarSession::note_nobody(HostTime now) {
  if (unit_) return;
  if (!searching_since_) searching_since_ = now;
  if (now - *searching_since_ < kNobodyAfter) return;
  const std::string wanted = config_.serial_number.empty() ? "no LiDAR" : "not " + config_.serial_number;
  note_unreachable(wanted + " has answered: check power, cable and this machine's address");
}

void LidarSession::note_sampling(HostTime now) {
  if (!watch_.silent()) rearm_pause_ = kFirstRearmPause;
  next_rearm_ = now + rearm_pause_;
  watch_.expect(now, kFirstDataPatience);
  tell(LidarEventKind::kSampling, unit_->serial_number + " at " + to_string(unit_->at.ip));
}

}  // namespace edgesplat::livox
