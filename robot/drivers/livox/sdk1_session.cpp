// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/sdk1_session.hpp"

#include <array>

namespace edgesplat::livox {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kUnitPort = 65000;
constexpr nanoseconds kHeartbeatPeriod = 800ms;
constexpr int kMissedForLoss = 3;
constexpr nanoseconds kFresh = 300ms;  // data this young: an announcement was overtaken by the handshake

constexpr std::array kSettings{Sdk1Command::kDeviceInfo, Sdk1Command::kCoordinate, Sdk1Command::kReturnMode,
                               Sdk1Command::kImuRate, Sdk1Command::kSampling};

const char* name_of(Sdk1Command setting) {
  switch (setting) {
    case Sdk1Command::kHandshake:
      return "handshake";
    case Sdk1Command::kCoordinate:
      return "Cartesian points";
    case Sdk1Command::kReturnMode:
      return "return mode";
    case Sdk1Command::kImuRate:
      return "IMU rate";
    case Sdk1Command::kSampling:
      return "to measure";
    default:
      return "request";
  }
}

const char* sync_name(std::uint8_t time_sync) {
  constexpr std::array<const char*, 5> kNames{"none", "ptp", "gps", "pps", "abnormal"};
  return time_sync < kNames.size() ? kNames.at(time_sync) : "abnormal";
}

}  // namespace

HostTime Sdk1Session::step_protocol(HostTime now) {
  if (in_session() && now >= next_heartbeat_) heartbeat(now);
  return in_session() ? next_heartbeat_ : HostTime::max();
}

/// A LiDAR in search of a host announces itself; only where it is known, and perhaps still bound to a host
/// that is gone, is there something to send.
void Sdk1Session::search(HostTime now) {
  if (!unit_ && config_.address) unit_ = Unit{config_.serial_number, {*config_.address, kUnitPort}};
  if (unit_) shake_hands(now);
}

void Sdk1Session::shake_hands(HostTime now) {
  const auto host = host_towards_(unit_->at.ip);
  if (!host) {
    note_unreachable("no way leads from this machine to " + to_string(unit_->at.ip));
    search_from(now + kPace.search_period);
    return;
  }
  phase_ = Phase::kHandshake;
  request(encode_sdk1_handshake(++sequence_,
                                {*host, config_.points_port, config_.control_port, config_.imu_port}),
          now);
}

void Sdk1Session::heartbeat(HostTime now) {
  next_heartbeat_ = now + kHeartbeatPeriod;
  if (missed_heartbeats_++ >= kMissedForLoss) {
    note_unreachable(unit_->serial_number + " at " + to_string(unit_->at.ip) + " (heartbeat)");
    search_from(now);
    return;
  }
  send(unit_->at, encode_sdk1_request(++sequence_, Sdk1Command::kHeartbeat));
}

void Sdk1Session::begin_settings(HostTime now) {
  phase_ = Phase::kSettings;
  setting_ = 0;
  missed_heartbeats_ = 0;
  next_heartbeat_ = now + kHeartbeatPeriod;
  next_setting(now);
}

void Sdk1Session::next_setting(HostTime now) {
  if (setting_ == kSettings.size()) {
    phase_ = Phase::kSampling;
    note_sampling(now);
    return;
  }
  const Sdk1Command setting = kSettings.at(setting_);
  ++sequence_;
  switch (setting) {
    case Sdk1Command::kReturnMode:
      request(encode_sdk1_request(sequence_, setting, static_cast<std::uint8_t>(config_.return_mode)), now);
      break;
    case Sdk1Command::kImuRate:
      request(encode_sdk1_request(sequence_, setting, config_.has_imu ? std::uint8_t{1} : std::uint8_t{0}),
              now);
      break;
    case Sdk1Command::kSampling:
      request(encode_sdk1_request(sequence_, setting, std::uint8_t{1}), now);
      break;
    case Sdk1Command::kCoordinate:
      request(encode_sdk1_request(sequence_, setting, std::uint8_t{0}), now);
      break;
    default:
      request(encode_sdk1_request(sequence_, setting), now);
  }
}

void Sdk1Session::bring_up_again(HostTime now) {
  // In session still, as far as is known: its settings again. Where they are not answered, the handshake.
  if (phase_ == Phase::kSampling) begin_settings(now);
}

void Sdk1Session::on_control(Channel, const Endpoint& from, std::span<const std::byte> datagram,
                             HostTime now) {
  const auto frame = decode_sdk1(datagram);
  if (!frame) {
    ++counters_.bad_frames;
    return;
  }
  if (frame->command == Sdk1Command::kAnnouncement && frame->type == Sdk1FrameType::kMessage) {
    on_announcement(*frame, from, now);
    return;
  }
  if (!is_from_unit(from.ip)) return;
  if (frame->command == Sdk1Command::kStatusPush) {
    if (const auto word = decode_sdk1_status_push(*frame)) learn_status(*word);
    return;
  }
  if (frame->type != Sdk1FrameType::kAck) return;
  if (frame->command == Sdk1Command::kHeartbeat) {
    on_heartbeat(*frame);
  } else if (pending_.acknowledge(frame->sequence)) {
    on_ack(*frame, now);
  }
}

void Sdk1Session::on_announcement(const Sdk1Frame& frame, const Endpoint& from, HostTime now) {
  const auto announcement = decode_sdk1_announcement(frame);
  if (!announcement) {
    ++counters_.bad_frames;
    return;
  }
  if (!is_wanted(announcement->serial_number, from.ip)) return;
  const bool known = unit_ && unit_->serial_number == announcement->serial_number;
  const bool moved = unit_ && unit_->at.ip != from.ip;
  const bool overtaken = phase_ == Phase::kSampling && watch_.is_fresh(now, kFresh);
  if (!moved && (phase_ == Phase::kHandshake || overtaken)) return;
  meet(announcement->serial_number, from);
  if (!known) tell(LidarEventKind::kFound, announcement->serial_number + " at " + to_string(from.ip));
  shake_hands(now);
}

void Sdk1Session::on_ack(const Sdk1Frame& frame, HostTime now) {
  note_heard();
  const auto code = decode_sdk1_return_code(frame);
  if (!code) {
    ++counters_.bad_frames;
    return;
  }
  if (*code != 0)
    tell(LidarEventKind::kRefused, std::string(name_of(frame.command)) + ": code " + std::to_string(*code));
  if (phase_ == Phase::kHandshake) {
    if (*code == 0) {
      begin_settings(now);
    } else {
      search_from(now + kPace.search_period);
    }
  } else if (phase_ == Phase::kSettings) {
    ++setting_;
    next_setting(now);
  }
}

void Sdk1Session::on_heartbeat(const Sdk1Frame& frame) {
  const auto heartbeat = decode_sdk1_heartbeat(frame);
  if (!heartbeat) {
    ++counters_.bad_frames;
    return;
  }
  note_heard();
  missed_heartbeats_ = 0;
  constexpr std::uint8_t kStarting = 0;
  constexpr std::uint8_t kError = 4;
  if (heartbeat->work_state == kError && health_.work_state != kError)
    tell(LidarEventKind::kFault, "work state: error");
  health_.work_state = heartbeat->work_state;
  if (heartbeat->work_state != kStarting) learn_status(heartbeat->status_or_progress);
}

void Sdk1Session::learn_status(std::uint32_t word) {
  const Sdk1Status status = read_sdk1_status(word);
  note_sync(sync_name(status.time_sync));
  if (status.system != 0 && status.system != last_system_status_)
    tell(LidarEventKind::kFault,
         "system " + std::to_string(status.system) + ", temperature " + std::to_string(status.temperature) +
             ", voltage " + std::to_string(status.voltage) + ", motor " + std::to_string(status.motor) +
             ", window " + std::to_string(status.dirty_window));
  last_system_status_ = status.system;
}

void Sdk1Session::send_utc(std::int64_t utc_ns) {
  send(unit_->at, encode_sdk1_utc(++sequence_, utc_ns));
}

void Sdk1Session::stop(HostTime) {
  if (in_session()) send(unit_->at, encode_sdk1_request(++sequence_, Sdk1Command::kDisconnect));
  phase_ = Phase::kSearching;
}

}  // namespace edgesplat::livox
