// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/sdk2_unit.hpp"

#include "common/base/bytes.hpp"
#include "tools/virtual_device/sdk2_wire.hpp"

#include <algorithm>
#include <array>

namespace edgesplat::virtual_device {
namespace {

constexpr std::uint16_t kDiscoveryPort = 56000;
constexpr std::uint16_t kCommandPort = 56100;
constexpr std::uint16_t kPushPort = 56200;
constexpr std::uint16_t kPointsPort = 56300;
constexpr std::uint16_t kImuPort = 56400;
constexpr std::array<std::uint8_t, 4> kEverybody{255, 255, 255, 255};
constexpr std::int64_t kPushPeriod_ns = 1'000'000'000;
constexpr std::uint8_t kMid360 = 9;

// Keys, sensor-protocols sheet 1.4.
constexpr std::uint16_t kPointType = 0x0000;
constexpr std::uint16_t kPushHost = 0x0005;
constexpr std::uint16_t kPointHost = 0x0006;
constexpr std::uint16_t kImuHost = 0x0007;
constexpr std::uint16_t kWorkMode = 0x001A;
constexpr std::uint16_t kImuEnabled = 0x001C;
constexpr std::uint16_t kReadOnlyFrom = 0x8000;
constexpr std::array kPushed{std::uint16_t{0x8000}, std::uint16_t{0x8006}, std::uint16_t{0x8007},
                             std::uint16_t{0x800A}, std::uint16_t{0x800B}, std::uint16_t{0x800C},
                             std::uint16_t{0x8011}};

constexpr std::uint8_t kGood = 0x00;
constexpr std::uint8_t kOutOfRange = 0x03;
constexpr std::uint8_t kUnknownKey = 0x20;
constexpr std::uint8_t kReadOnly = 0x22;
constexpr std::uint8_t kBadLength = 0x23;
constexpr std::uint8_t kBadCount = 0x24;

std::vector<std::byte> one_byte(std::uint8_t value) {
  return {std::byte{value}};
}

template <typename T>
std::vector<std::byte> bytes_of(T value) {
  ByteWriter writer;
  writer.write(value);
  return writer.take();
}

std::vector<std::byte> serial_bytes(const std::string& serial_number) {
  ByteWriter writer;
  writer.write_text(serial_number.substr(0, 15));
  while (writer.size() < 16) writer.write(std::uint8_t{0});
  return writer.take();
}

void write_entry(ByteWriter& writer, std::uint16_t key, std::span<const std::byte> value) {
  writer.write(key);
  writer.write(static_cast<std::uint16_t>(value.size()));
  writer.write_bytes(value);
}

}  // namespace

Sdk2Unit::Sdk2Unit(VirtualUnitConfig config, std::int64_t now_ns) : VirtualUnit(std::move(config), now_ns) {
  // As it leaves the factory: 192.168.1.5 gets everything, and nobody is asked.
  for (const std::uint16_t key : {kPushHost, kPointHost, kImuHost}) {
    const auto offset = static_cast<std::uint16_t>(100 * (key - kPushHost));
    ByteWriter writer;
    writer.write(std::uint32_t{0x0501A8C0});  // 192.168.1.5
    writer.write(static_cast<std::uint16_t>(56201 + offset));
    writer.write(static_cast<std::uint16_t>(56200 + offset));
    stored_[key] = writer.take();
  }
  stored_[kPointType] = one_byte(1);
  stored_[kImuEnabled] = one_byte(1);
  stored_[kWorkMode] = one_byte(kIdle);
  next_push_ns_ = now_ns;
}

std::vector<std::uint16_t> Sdk2Unit::command_ports() const {
  return {kDiscoveryPort, kCommandPort};
}
std::vector<std::uint16_t> Sdk2Unit::sending_ports() const {
  return {kPushPort, kPointsPort, kImuPort};
}

Sdk2Unit::State Sdk2Unit::state(std::int64_t now_ns) const {
  if (stored_.at(kWorkMode).front() != std::byte{kSampling})
    return static_cast<State>(std::to_integer<std::uint8_t>(stored_.at(kWorkMode).front()));
  return now_ns >= measures_from_ns_ ? kSampling : kMotorStart;
}

void Sdk2Unit::forget(std::int64_t now_ns) {
  if (!config_.starts_by_itself) stored_[kWorkMode] = one_byte(kIdle);
  measures_from_ns_ = now_ns + seconds_to_ns(config_.motor_s);
  next_push_ns_ = now_ns;
  points_sent_ = 0;
  imu_sent_ = 0;
}

void Sdk2Unit::answer(std::uint16_t port, const UnitAddress& from, std::span<const std::byte> datagram,
                      std::int64_t now_ns) {
  const auto parsed = parse_sdk2_request(datagram);
  if (!parsed) {
    // Other LiDARs' answers reach the discovery port as well.
    if (port != kDiscoveryPort) ++counters_.bad_frames;
    return;
  }
  const Request request{parsed->sequence, parsed->command, parsed->content};
  ++counters_.requests;
  if (port == kDiscoveryPort) {
    if (request.command == 0x0000) discover(request, from);
    return;
  }
  ByteReader content(request.content);
  switch (request.command) {
    case 0x0100:
      set_parameters(request, from, now_ns);
      return;
    case 0x0101:
      query(request, from, now_ns);
      return;
    case 0x0200:
      acknowledge(request, from, one_byte(kGood));
      power_cycle(now_ns + content.read<std::uint16_t>() * 1'000'000LL, 0);
      return;
    case 0x0202: {
      const bool is_ns = content.read<std::uint8_t>() == 2;
      const auto utc_ns = content.read<std::uint64_t>();
      const bool good = is_ns && content.ok();
      // At any time after the pulse up to 430 ms; 900 ms are the most it takes from the serial line.
      if (good) hear_second(now_ns, static_cast<std::int64_t>(utc_ns), 0, 430'000'000);
      acknowledge(request, from, one_byte(good ? kGood : kOutOfRange));
      return;
    }
    default:
      ++counters_.refused;
      acknowledge(request, from, one_byte(0x01));
  }
}

void Sdk2Unit::acknowledge(const Request& request, const UnitAddress& to,
                           std::span<const std::byte> content) {
  outgoing_.push_back(
      {kCommandPort, to, make_sdk2_frame(request.sequence, request.command, Sdk2Kind::kAck, content)});
}

void Sdk2Unit::discover(const Request& request, const UnitAddress& from) {
  ByteWriter content;
  content.write(kGood);
  content.write(kMid360);
  content.write_bytes(serial_bytes(config_.serial_number));
  for (const std::uint8_t part : config_.ip) content.write(part);
  content.write(kCommandPort);
  // To everybody, so that it reaches a host of another subnet.
  acknowledge(request, {kEverybody, from.port}, content.bytes());
}

std::uint8_t Sdk2Unit::judge(std::uint16_t key, std::span<const std::byte> value) const {
  if (key >= kReadOnlyFrom) return kReadOnly;
  const auto known = stored_.find(key);
  if (known == stored_.end()) return kUnknownKey;
  if (value.size() != known->second.size()) return kBadLength;
  const auto first = std::to_integer<std::uint8_t>(value.front());
  if (key == kWorkMode && first != kSampling && first != kIdle && first != kReady) return kOutOfRange;
  if (key == kPointType && (first < 1 || first > 3)) return kOutOfRange;
  if (key == kImuEnabled && first > 1) return kOutOfRange;
  return kGood;
}

void Sdk2Unit::set_parameters(const Request& request, const UnitAddress& from, std::int64_t now_ns) {
  ByteReader reader(request.content);
  const auto count = reader.read<std::uint16_t>();
  reader.skip(2);
  std::uint8_t code = kGood;
  std::uint16_t error_key = 0;
  for (std::uint16_t i = 0; i < count && code == kGood; ++i) {
    const auto key = reader.read<std::uint16_t>();
    const auto value = reader.take(reader.read<std::uint16_t>());
    code = reader.ok() ? judge(key, value) : kBadCount;
    if (code != kGood) {
      error_key = key;
      break;
    }
    std::vector<std::byte>& stored = stored_[key];
    if (key == kWorkMode && value.front() == std::byte{kSampling} && state(now_ns) != kSampling) {
      measures_from_ns_ = now_ns + seconds_to_ns(config_.motor_s);
      ++counters_.sessions;
    }
    if (!std::ranges::equal(stored, value)) ++counters_.written;
    stored.assign(value.begin(), value.end());
  }
  if (code != kGood) ++counters_.refused;
  ByteWriter content;
  content.write(code);
  content.write(error_key);
  acknowledge(request, from, content.bytes());
}

void Sdk2Unit::query(const Request& request, const UnitAddress& from, std::int64_t now_ns) {
  ByteReader reader(request.content);
  const auto count = reader.read<std::uint16_t>();
  reader.skip(2);
  ByteWriter list;
  std::uint16_t answered = 0;
  std::uint8_t code = kGood;
  for (std::uint16_t i = 0; i < count; ++i) {
    const auto key = reader.read<std::uint16_t>();
    const auto value = reader.ok() ? value_of(key, now_ns) : std::nullopt;
    if (!value) {
      code = reader.ok() ? kUnknownKey : kBadCount;
      break;
    }
    write_entry(list, key, *value);
    ++answered;
  }
  if (code != kGood) ++counters_.refused;
  ByteWriter content;
  content.write(code);
  content.write(answered);
  content.write_bytes(list.bytes());
  acknowledge(request, from, content.bytes());
}

std::optional<std::vector<std::byte>> Sdk2Unit::value_of(std::uint16_t key, std::int64_t now_ns) const {
  if (const auto stored = stored_.find(key); stored != stored_.end()) return stored->second;
  const auto held_by = clock_.held_by(now_ns);
  switch (key) {
    case 0x8000:
      return serial_bytes(config_.serial_number);
    case 0x8006:
      return one_byte(state(now_ns));
    case 0x8007:
      return bytes_of(std::int32_t{4250});  // 42.5 degrees
    case 0x8009:
      return bytes_of(clock_.stamp_ns(now_ns));
    case 0x800A:
      return bytes_of(held_by == UnitSync::kNone ? std::int64_t{0} : now_ns);
    case 0x800B:
      return bytes_of(clock_.offset_ns(now_ns));
    case 0x800C:
      return one_byte(held_by == UnitSync::kNone ? 0 : (held_by == UnitSync::kPtp ? 1 : 2));
    case 0x8010:
      return one_byte(1);  // its application, not its loader
    case 0x8011:
      return std::vector<std::byte>(32);
    default:
      return std::nullopt;
  }
}

std::optional<UnitAddress> Sdk2Unit::host(std::uint16_t key) const {
  ByteReader reader(stored_.at(key));
  UnitAddress address;
  for (std::uint8_t& part : address.ip) part = reader.read<std::uint8_t>();
  address.port = reader.read<std::uint16_t>();
  return address.port == 0 ? std::nullopt : std::optional(address);
}

void Sdk2Unit::act(std::int64_t now_ns) {
  if (now_ns < next_push_ns_) return;
  next_push_ns_ = now_ns + kPushPeriod_ns;
  const auto to = host(kPushHost);
  if (!to) return;
  ByteWriter content;
  content.write(static_cast<std::uint16_t>(kPushed.size()));
  content.write(std::uint16_t{0});
  for (const std::uint16_t key : kPushed) write_entry(content, key, *value_of(key, now_ns));
  outgoing_.push_back(
      {kPushPort, *to, make_sdk2_frame(++next_sequence_, 0x0102, Sdk2Kind::kRequest, content.bytes())});
}

std::optional<VirtualUnit::Outgoing> Sdk2Unit::restamp(std::span<const std::byte> recorded,
                                                       std::uint16_t host_key, std::uint16_t from_port,
                                                       std::int64_t true_ns) {
  if (!is_up(true_ns) || state(true_ns) != kSampling) return std::nullopt;
  const auto to = host(host_key);
  if (!to) return std::nullopt;
  const UnitSync held_by = clock_.held_by(true_ns);
  Sdk2Stamp stamp;
  stamp.time_type = held_by == UnitSync::kNone ? 0 : (held_by == UnitSync::kPtp ? 1 : 2);
  stamp.stamp_ns = clock_.stamp_ns(true_ns);
  stamp.udp_count = host_key == kPointHost ? points_sent_++ : imu_sent_++;
  std::vector<std::byte> bytes(recorded.begin(), recorded.end());
  if (!restamp_sdk2(bytes, stamp)) return std::nullopt;
  return Outgoing{from_port, *to, std::move(bytes)};
}

std::optional<VirtualUnit::Outgoing> Sdk2Unit::points(std::span<const std::byte> recorded,
                                                      std::int64_t true_ns) {
  return restamp(recorded, kPointHost, kPointsPort, true_ns);
}

std::optional<VirtualUnit::Outgoing> Sdk2Unit::imu(std::span<const std::byte> recorded,
                                                   std::int64_t true_ns) {
  if (stored_.at(kImuEnabled).front() != std::byte{1}) return std::nullopt;
  return restamp(recorded, kImuHost, kImuPort, true_ns);
}

}  // namespace edgesplat::virtual_device
