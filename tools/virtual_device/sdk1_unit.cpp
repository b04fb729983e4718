// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/sdk1_unit.hpp"

#include "common/base/bytes.hpp"
#include "tools/virtual_device/sdk1_wire.hpp"
#include "tools/virtual_device/sdk2_wire.hpp"

#include <array>

namespace edgesplat::virtual_device {
namespace {

constexpr std::uint16_t kUnitPort = 65000;
constexpr std::uint16_t kAnnouncementPort = 55000;
constexpr std::array<std::uint8_t, 4> kEverybody{255, 255, 255, 255};
constexpr std::int64_t kAnnouncementPeriod_ns = 1'000'000'000;
constexpr std::int64_t kHostGoneAfter_ns = 3'000'000'000;
constexpr std::uint8_t kAvia = 7;
constexpr std::uint8_t kTaggedPoints = 2;
constexpr std::uint8_t kInertia = 6;
constexpr std::size_t kTaggedBytes = std::size_t{96} * 14;
constexpr std::size_t kInertiaBytes = 24;

constexpr std::uint16_t kHandshake = 0x0001;
constexpr std::uint16_t kDeviceInfo = 0x0002;
constexpr std::uint16_t kHeartbeat = 0x0003;
constexpr std::uint16_t kSampling = 0x0004;
constexpr std::uint16_t kCoordinate = 0x0005;
constexpr std::uint16_t kDisconnect = 0x0006;
constexpr std::uint16_t kReturnMode = 0x0106;
constexpr std::uint16_t kImuRate = 0x0108;
constexpr std::uint16_t kUtcSync = 0x010A;

}  // namespace

Sdk1Unit::Sdk1Unit(VirtualUnitConfig config, std::int64_t now_ns) : VirtualUnit(std::move(config), now_ns) {
  next_announcement_ns_ = now_ns;
}

std::vector<std::uint16_t> Sdk1Unit::command_ports() const {
  return {kUnitPort};
}

bool Sdk1Unit::is_measuring(std::int64_t now_ns) const {
  return host_ && measures_ && now_ns >= measures_from_ns_;
}

void Sdk1Unit::forget(std::int64_t now_ns) {
  host_.reset();
  measures_ = false;
  sends_imu_ = false;
  next_announcement_ns_ = now_ns;
}

void Sdk1Unit::act(std::int64_t now_ns) {
  if (host_ && now_ns - heard_ns_ > kHostGoneAfter_ns) {
    host_.reset();
    measures_ = false;
  }
  if (host_ || now_ns < next_announcement_ns_) return;
  next_announcement_ns_ = now_ns + kAnnouncementPeriod_ns;
  ByteWriter content;
  content.write_text(
      (config_.serial_number + "1").substr(0, 15));  // the broadcast code has one more character
  while (content.size() < 16) content.write(std::uint8_t{0});
  content.write(kAvia);
  content.write(std::uint16_t{0});
  outgoing_.push_back({kUnitPort,
                       {kEverybody, kAnnouncementPort},
                       make_sdk1_frame(++next_sequence_, 0x0000, Sdk1Kind::kMessage, content.bytes())});
}

void Sdk1Unit::acknowledge(std::uint16_t sequence, std::uint16_t command, const UnitAddress& to,
                           std::span<const std::byte> content) {
  outgoing_.push_back({kUnitPort, to, make_sdk1_frame(sequence, command, Sdk1Kind::kAck, content)});
}

void Sdk1Unit::answer(std::uint16_t, const UnitAddress& from, std::span<const std::byte> datagram,
                      std::int64_t now_ns) {
  const auto request = parse_sdk1_request(datagram);
  if (!request) {
    ++counters_.bad_frames;
    return;
  }
  ++counters_.requests;
  ByteReader content(request->content);
  if (request->command == kHandshake) {
    Host host;
    std::array<std::uint8_t, 4> ip{};
    for (std::uint8_t& part : ip) part = content.read<std::uint8_t>();
    host.points = {ip, content.read<std::uint16_t>()};
    host.commands = {ip, content.read<std::uint16_t>()};
    host.imu = {ip, content.read<std::uint16_t>()};
    if (!content.ok()) return;
    host_ = host;
    heard_ns_ = now_ns;
    ++counters_.sessions;
    acknowledge(request->sequence, kHandshake, host.commands, std::vector<std::byte>(1));
    return;
  }
  // Only the host of the handshake has a say.
  if (!host_ || from.ip != host_->commands.ip) return;
  heard_ns_ = now_ns;
  ByteWriter reply;
  reply.write(std::uint8_t{0});
  if (request->command == kDeviceInfo) {
    reply.write(std::uint32_t{0x0500'090BU});  // firmware 11.09.0005
  } else if (request->command == kHeartbeat) {
    reply.write(std::uint8_t{1});  // normal
    reply.write(std::uint8_t{0});
    reply.write(status_word(now_ns));
  } else if (request->command == kUtcSync) {
    if (const auto utc_ns = read_sdk1_date(request->content))
      hear_second(now_ns, *utc_ns, 10'000'000, 500'000'000);
  } else if (request->command != kDisconnect) {
    set(request->command, content.read<std::uint8_t>(), now_ns);
  }
  acknowledge(request->sequence, request->command, host_->commands, reply.bytes());
  if (request->command == kDisconnect) forget(now_ns);
}

void Sdk1Unit::set(std::uint16_t command, std::uint8_t value, std::int64_t now_ns) {
  ++counters_.written;
  if (command == kSampling) {
    const bool starts = value == 1 && !measures_;
    measures_ = value == 1;
    if (starts) measures_from_ns_ = now_ns + seconds_to_ns(config_.motor_s);
  } else if (command == kImuRate) {
    sends_imu_ = value == 1;
  } else if (command != kCoordinate && command != kReturnMode) {
    ++counters_.refused;
  }
}

std::uint32_t Sdk1Unit::status_word(std::int64_t now_ns) const {
  const UnitSync held_by = clock_.held_by(now_ns);
  const auto time_sync = static_cast<std::uint32_t>(held_by);  // 0 none, 1 PTP, 2 GPS
  std::uint32_t word = time_sync << 14U;
  if (held_by == UnitSync::kPtp) word |= 1U << 13U;
  if (config_.clock.sync == UnitSync::kPulse) word |= 1U << 9U;
  return word;
}

std::optional<VirtualUnit::Outgoing> Sdk1Unit::data(std::uint8_t type, const UnitAddress& to,
                                                    std::span<const std::byte> records,
                                                    std::int64_t true_ns) const {
  const UnitSync held_by = clock_.held_by(true_ns);
  const std::int64_t stamp_ns = clock_.stamp_ns(true_ns);
  ByteWriter packet;
  packet.write(std::uint8_t{5});
  packet.write(std::uint8_t{0});
  packet.write(std::uint8_t{1});
  packet.write(std::uint8_t{0});
  packet.write(status_word(true_ns));
  packet.write(
      static_cast<std::uint8_t>(held_by == UnitSync::kPulse ? 3 : (held_by == UnitSync::kPtp ? 1 : 0)));
  packet.write(type);
  if (held_by == UnitSync::kPulse) {
    write_sdk1_date(packet, stamp_ns);
  } else {
    packet.write(static_cast<std::uint64_t>(stamp_ns));
  }
  packet.write_bytes(records);
  return Outgoing{kUnitPort, to, packet.take()};
}

std::optional<VirtualUnit::Outgoing> Sdk1Unit::points(std::span<const std::byte> recorded,
                                                      std::int64_t true_ns) {
  const auto records = recorded_records(recorded);
  if (!is_up(true_ns) || !is_measuring(true_ns) || records.size() != kTaggedBytes) return std::nullopt;
  // A tagged point has the same 14 bytes in both protocols, but the tag says other things: 0 is good in both.
  std::vector<std::byte> tagged(records.begin(), records.end());
  for (std::size_t at = 13; at < tagged.size(); at += 14) tagged[at] = std::byte{0};
  return data(kTaggedPoints, host_->points, tagged, true_ns);
}

std::optional<VirtualUnit::Outgoing> Sdk1Unit::imu(std::span<const std::byte> recorded,
                                                   std::int64_t true_ns) {
  const auto records = recorded_records(recorded);
  if (!is_up(true_ns) || !is_measuring(true_ns) || !sends_imu_ || records.size() != kInertiaBytes)
    return std::nullopt;
  return data(kInertia, host_->imu, records, true_ns);
}

}  // namespace edgesplat::virtual_device
