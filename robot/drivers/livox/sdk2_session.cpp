// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/sdk2_session.hpp"

#include "common/base/bytes.hpp"

#include <algorithm>
#include <array>

namespace edgesplat::livox {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kDiscoveryPort = 56000;
constexpr std::uint16_t kControlPort = 56100;
constexpr std::uint16_t kUnitPushPort = 56200;
constexpr std::uint16_t kUnitPointsPort = 56300;
constexpr std::uint16_t kUnitImuPort = 56400;
constexpr nanoseconds kPollPeriod = 200ms;
constexpr nanoseconds kLongestStart = 20s;  // a motor takes seconds
constexpr nanoseconds kRetryLater = 5s;
constexpr std::uint16_t kRebootDelay_ms = 100;

constexpr std::uint8_t kDone = 0x00;
constexpr std::uint8_t kDoneAfterReboot = 0x21;
constexpr std::uint8_t kStateSampling = 1;
constexpr std::uint8_t kStateError = 4;
constexpr std::uint8_t kPointType = 1;  // int32 millimetres
constexpr std::uint8_t kLoader = 0;

constexpr std::array kRead{Key::kSerialNumber,  Key::kFirmwareType, Key::kWorkState,
                           Key::kPointDataType, Key::kStateHost,    Key::kPointHost,
                           Key::kImuHost,       Key::kWorkMode,     Key::kImuEnabled};

std::string hex_key(std::uint16_t key) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string text;
  for (const unsigned shift : {12U, 8U, 4U, 0U}) text.push_back(kDigits[(key >> shift) & 15U]);
  return text;
}

}  // namespace

std::uint32_t Sdk2Session::next_sequence() {
  constexpr std::uint32_t kLast = 65535;  // as the vendor's library counts
  sequence_ = sequence_ % kLast + 1;
  return sequence_;
}

HostTime Sdk2Session::step_protocol(HostTime now) {
  if (phase_ == Phase::kStarting && !pending_.waits() && now >= next_poll_) {
    if (now >= start_deadline_) {
      note_unreachable(unit_->serial_number + " does not start: work state " +
                       std::to_string(health_.work_state));
      search_from(now + kRetryLater);
    } else {
      const std::array keys{Key::kWorkState};
      request(encode_query(next_sequence(), keys), now);
    }
  }
  return phase_ == Phase::kStarting && !pending_.waits() ? next_poll_ : HostTime::max();
}

void Sdk2Session::search(HostTime now) {
  if (config_.address) {
    if (!unit_) unit_ = Unit{config_.serial_number, {*config_.address, kControlPort}};
    read_parameters(now);
    return;
  }
  send({kBroadcast, kDiscoveryPort}, encode_discovery(next_sequence()));
}

void Sdk2Session::on_control(Channel, const Endpoint& from, std::span<const std::byte> datagram,
                             HostTime now) {
  const auto frame = decode_command(datagram);
  if (!frame) {
    ++counters_.bad_frames;
    return;
  }
  if (!frame->from_lidar) return;  // another host's discovery
  if (frame->id == CommandId::kDiscovery) {
    on_discovered(*frame, now);
    return;
  }
  if (!is_from_unit(from.ip)) return;
  if (frame->id == CommandId::kStatePush) on_push(*frame, now);
  if (!frame->is_ack || !pending_.acknowledge(frame->sequence)) return;
  note_heard();
  if (frame->id == CommandId::kReboot) return;
  const auto reply = decode_parameter_reply(*frame);
  if (!reply) {
    ++counters_.bad_frames;
    search_from(now + kPace.search_period);
    return;
  }
  on_reply(*reply, now);
}

void Sdk2Session::on_discovered(const CommandFrame& frame, HostTime now) {
  const auto lidar = decode_discovery_ack(frame);
  if (!lidar) {
    ++counters_.bad_frames;
    return;
  }
  if (!is_wanted(lidar->serial_number, lidar->ip)) return;
  const bool moved = unit_ && unit_->at.ip != lidar->ip;
  if (phase_ != Phase::kSearching && !moved) return;  // a late answer
  const bool known = unit_.has_value();
  meet(lidar->serial_number, {lidar->ip, lidar->command_port});
  if (!known) tell(LidarEventKind::kFound, lidar->serial_number + " at " + to_string(lidar->ip));
  read_parameters(now);
}

void Sdk2Session::read_parameters(HostTime now) {
  phase_ = Phase::kReading;
  request(encode_query(next_sequence(), kRead), now);
}

void Sdk2Session::on_reply(const ParameterReply& reply, HostTime now) {
  Sdk2Report report;
  switch (phase_) {
    case Phase::kReading:
      on_parameters(reply, now);
      return;
    case Phase::kConfiguring:
      if (reply.return_code == kDoneAfterReboot && !std::exchange(was_rebooted_, true)) {
        request(encode_reboot(next_sequence(), kRebootDelay_ms), now);
        search_from(now + kPace.search_period);
        return;
      }
      if (reply.return_code != kDone && reply.return_code != kDoneAfterReboot)
        tell(LidarEventKind::kRefused,
             "key " + hex_key(reply.error_key) + ": " + std::string(describe_return_code(reply.return_code)));
      start(now);
      return;
    case Phase::kStarting:
      report = read_report(reply.parameters);
      learn_health(report);
      if (reply.return_code != kDone)
        tell(LidarEventKind::kRefused, "to measure: " + std::string(describe_return_code(reply.return_code)));
      if (report.work_state == kStateSampling) {
        begin_sampling(now);
      } else {
        next_poll_ = now + kPollPeriod;
      }
      return;
    case Phase::kSearching:
    case Phase::kSampling:
      return;
  }
}

void Sdk2Session::on_parameters(const ParameterReply& reply, HostTime now) {
  found_ = read_report(reply.parameters);
  const std::string serial_number = found_.serial_number.value_or("");
  if (config_.address && !serial_number.empty()) {
    if (!is_wanted(serial_number, unit_->at.ip)) {
      search_from(now + kRetryLater);
      return;
    }
    if (unit_->serial_number != serial_number)
      tell(LidarEventKind::kFound, serial_number + " at " + to_string(unit_->at.ip));
    unit_->serial_number = serial_number;
  }
  if (found_.firmware_type == kLoader) {
    if (!std::exchange(told_no_firmware_, true))
      tell(LidarEventKind::kNoFirmware, unit_->serial_number + " runs its loader: load its firmware again");
    search_from(now + kRetryLater);
    return;
  }
  learn_health(found_);
  if (!configure(reply.parameters, now)) start(now);
}

bool Sdk2Session::configure(const std::vector<KeyValue>& values, HostTime now) {
  const auto host = host_towards_(unit_->at.ip);
  if (!host) {
    note_unreachable("no way leads from this machine to " + to_string(unit_->at.ip));
    search_from(now + kRetryLater);
    return true;
  }
  const auto push_host = encode_host({*host, config_.push_port, kUnitPushPort});
  const auto points_host = encode_host({*host, config_.points_port, kUnitPointsPort});
  const auto imu_host = encode_host({*host, config_.imu_port, kUnitImuPort});
  const std::array<std::uint8_t, 1> type{kPointType};
  const std::array<std::uint8_t, 1> imu_on{config_.has_imu ? std::uint8_t{1} : std::uint8_t{0}};
  const std::array<KeyValue, 5> wanted{
      KeyValue{Key::kStateHost, push_host}, KeyValue{Key::kPointHost, points_host},
      KeyValue{Key::kImuHost, imu_host}, KeyValue{Key::kPointDataType, std::as_bytes(std::span(type))},
      KeyValue{Key::kImuEnabled, std::as_bytes(std::span(imu_on))}};
  std::vector<KeyValue> different;
  for (const KeyValue& one : wanted) {
    const auto has = std::find_if(values.begin(), values.end(),
                                  [&one](const KeyValue& other) { return other.key == one.key; });
    if (has == values.end() || !std::ranges::equal(has->value, one.value)) different.push_back(one);
  }
  if (different.empty()) return false;
  phase_ = Phase::kConfiguring;
  request(encode_set_parameters(next_sequence(), different), now);
  return true;
}

void Sdk2Session::start(HostTime now) {
  const bool measures = found_.work_state == kStateSampling &&
                        found_.work_mode == static_cast<std::uint8_t>(WorkMode::kSampling);
  if (measures) {
    begin_sampling(now);
    return;
  }
  phase_ = Phase::kStarting;
  start_deadline_ = now + kLongestStart;
  request(encode_set_work_mode(next_sequence(), WorkMode::kSampling), now);
}

void Sdk2Session::begin_sampling(HostTime now) {
  phase_ = Phase::kSampling;
  told_no_firmware_ = false;
  note_sampling(now);
}

void Sdk2Session::on_push(const CommandFrame& frame, HostTime now) {
  const auto values = decode_state_push(frame);
  if (!values) {
    ++counters_.bad_frames;
    return;
  }
  note_heard();
  const Sdk2Report report = read_report(*values);
  learn_health(report);
  // Somebody stopped it, or it was restarted and does not start by itself.
  if (phase_ == Phase::kSampling && report.work_state && *report.work_state != kStateSampling)
    search_from(now);
}

void Sdk2Session::learn_health(const Sdk2Report& report) {
  if (report.work_state == kStateError && health_.work_state != kStateError)
    tell(LidarEventKind::kFault, "work state: error");
  health_.work_state = report.work_state.value_or(health_.work_state);
  health_.core_temperature_deg = report.core_temperature_deg.value_or(health_.core_temperature_deg);
  health_.time_offset_ns = report.time_offset_ns.value_or(health_.time_offset_ns);
  if (report.sync) note_sync(*report.sync);
  if (!report.faults) return;
  if (!report.faults->empty() && report.faults != last_faults_)
    tell(LidarEventKind::kFault, "codes " + *report.faults);
  last_faults_ = *report.faults;
}

void Sdk2Session::send_utc(std::int64_t utc_ns) {
  send(unit_->at, encode_set_gps_time(next_sequence(), static_cast<std::uint64_t>(utc_ns)));
}

}  // namespace edgesplat::livox
