// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/lidar_device.hpp"

#include "tools/virtual_device/sdk1_unit.hpp"
#include "tools/virtual_device/sdk2_unit.hpp"
#include "tools/virtual_device/sdk2_wire.hpp"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

namespace edgesplat::virtual_device {
namespace {

constexpr int kStep_ms = 10;
constexpr std::uint16_t kSharedPort = 56000;  // discovery is broadcast: every device on the machine listens

sockaddr_in to_sockaddr(const UnitAddress& address) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(address.port);
  std::memcpy(&to.sin_addr, address.ip.data(), address.ip.size());
  return to;
}

Result<UniqueFd> bind_port(const UnitAddress& at) {
  UniqueFd fd(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int on = 1;
  (void)::setsockopt(fd.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof(on));
  const bool shared = at.port == kSharedPort;
  if (shared) (void)::setsockopt(fd.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  // Broadcasts reach only sockets that are bound to no address.
  const sockaddr_in local = to_sockaddr(shared ? UnitAddress{{}, at.port} : at);
  if (::bind(fd.get(), reinterpret_cast<const sockaddr*>(&local), sizeof(local)) != 0) {
    const std::string where = std::to_string(at.ip[0]) + "." + std::to_string(at.ip[1]) + "." +
                              std::to_string(at.ip[2]) + "." + std::to_string(at.ip[3]) + ":" +
                              std::to_string(at.port);
    return fail(Errc::kIo, "the virtual LiDAR cannot have UDP " + where + ": " +
                               std::generic_category().message(errno) + "; give it another address");
  }
  return fd;
}

std::unique_ptr<VirtualUnit> make_unit(const LidarDeviceConfig& config, std::int64_t now_ns) {
  if (config.model == LidarModel::kAvia) return std::make_unique<Sdk1Unit>(config.unit, now_ns);
  return std::make_unique<Sdk2Unit>(config.unit, now_ns);
}

}  // namespace

Result<std::unique_ptr<LidarDevice>> LidarDevice::start(const LidarDeviceConfig& config, const Clock& clock) {
  std::unique_ptr<LidarDevice> device(new LidarDevice(config, clock, make_unit(config, to_ns(clock.now()))));
  EDGESPLAT_TRY_STATUS(device->bind_ports());
  LidarDevice& self = *device;
  self.worker_.emplace(
      thread::Worker("virtual-lidar", [&self](const std::stop_token& stop) { return self.serve(stop); }));
  return device;
}

LidarDevice::LidarDevice(const LidarDeviceConfig& config, const Clock& clock,
                         std::unique_ptr<VirtualUnit> unit)
    : clock_(clock),
      faults_(config.faults),
      unit_(std::move(unit)),
      noise_(config.seed, simulate::NoisePurpose::kStreamFault, 1) {
  std::ranges::stable_sort(faults_, {}, &LidarFault::at_s);
  // A pulse a second and UTC for it are the real ones; a PTP master is the recording's, see begin().
  if (config.unit.clock.sync == UnitSync::kPulse) unit_->clock().set_epoch(wall_clock_ns() - now_ns());
}

LidarDevice::~LidarDevice() = default;

Status LidarDevice::bind_ports() {
  sockets_.clear();
  auto ports = unit_->command_ports();
  const auto sending = unit_->sending_ports();
  ports.insert(ports.end(), sending.begin(), sending.end());
  for (const std::uint16_t port : ports) {
    EDGESPLAT_TRY(sockets_[port], bind_port({unit_->ip(), port}));
  }
  return {};
}

bool LidarDevice::wait_for_host(std::chrono::milliseconds timeout, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  return stepped_.wait_for(lock, stop, timeout, [this] {
    const std::int64_t now = now_ns();
    const bool held =
        unit_->clock().sync() == UnitSync::kNone || unit_->clock().held_by(now) != UnitSync::kNone;
    return held && unit_->is_measuring(now);
  });
}

void LidarDevice::begin(HostTime first) {
  const std::lock_guard lock(mutex_);
  started_ns_ = now_ns();
  recorded_minus_now_ns_ = to_ns(first) - started_ns_;
  if (unit_->clock().sync() == UnitSync::kPtp) unit_->clock().set_epoch(*recorded_minus_now_ns_);
}

bool LidarDevice::serve(const std::stop_token& stop) {
  std::vector<std::uint16_t> ports;
  std::vector<pollfd> fds;
  {
    const std::lock_guard lock(mutex_);
    ports = unit_->command_ports();
    for (const std::uint16_t port : ports) fds.push_back({sockets_.at(port).get(), POLLIN, 0});
  }
  (void)::poll(fds.data(), fds.size(), kStep_ms);
  const std::lock_guard lock(mutex_);
  const std::int64_t now = now_ns();
  take_commands(ports, now);
  unit_->step(now);
  for (const VirtualUnit::Outgoing& datagram : unit_->take_outgoing())
    if (!is_pulled(now) && !is_lost()) (void)send(datagram);
  if (recorded_minus_now_ns_) apply_faults(now);
  stepped_.notify_all();
  return !stop.stop_requested();
}

void LidarDevice::take_commands(const std::vector<std::uint16_t>& ports, std::int64_t now) {
  std::array<std::byte, 2048> buffer{};
  for (const std::uint16_t port : ports) {
    while (true) {
      sockaddr_in sender{};
      socklen_t length = sizeof(sender);
      const ssize_t n = ::recvfrom(sockets_.at(port).get(), buffer.data(), buffer.size(), 0,
                                   reinterpret_cast<sockaddr*>(&sender), &length);
      if (n < 0) break;
      if (is_pulled(now) || is_lost()) continue;
      UnitAddress from;
      std::memcpy(from.ip.data(), &sender.sin_addr, from.ip.size());
      from.port = ntohs(sender.sin_port);
      unit_->on_command(port, from, std::span(buffer).first(static_cast<std::size_t>(n)), now);
    }
  }
}

void LidarDevice::apply_faults(std::int64_t now) {
  const double played_s = static_cast<double>(now - started_ns_) * 1e-9;
  while (!faults_.empty() && faults_.front().at_s <= played_s) {
    apply(faults_.front(), now);
    faults_.erase(faults_.begin());
    ++counters_.faults;
  }
}

void LidarDevice::apply(const LidarFault& fault, std::int64_t now) {
  const std::int64_t until_ns = now + seconds_to_ns(fault.lasts_s);
  switch (fault.kind) {
    case LidarFault::Kind::kSilence:
      pulled_until_ns_ = until_ns;
      break;
    case LidarFault::Kind::kReboot:
      unit_->power_cycle(now, until_ns - now);
      break;
    case LidarFault::Kind::kAddress:
      unit_->power_cycle(now, until_ns - now);
      unit_->move_to(fault.address);
      // An address that is taken: it is off then for good, and unsent tells.
      if (!bind_ports()) pulled_until_ns_ = INT64_MAX;
      break;
    case LidarFault::Kind::kLoss:
      loss_ = fault.value;
      lossy_until_ns_ = until_ns;
      break;
    case LidarFault::Kind::kStuckSync:
      unit_->clock().lose_master(now);
      break;
    case LidarFault::Kind::kClockStep:
      unit_->clock().step_master(seconds_to_ns(fault.value));
      break;
  }
}

bool LidarDevice::is_lost() {
  if (now_ns() >= lossy_until_ns_ || noise_.uniform() >= loss_) return false;
  ++counters_.lost;
  return true;
}

bool LidarDevice::send(const VirtualUnit::Outgoing& datagram) {
  const auto socket = sockets_.find(datagram.from_port);
  if (socket == sockets_.end()) return false;
  const sockaddr_in to = to_sockaddr(datagram.to);
  const ssize_t n = ::sendto(socket->second.get(), datagram.bytes.data(), datagram.bytes.size(), MSG_NOSIGNAL,
                             reinterpret_cast<const sockaddr*>(&to), sizeof(to));
  const bool whole = n >= 0 && static_cast<std::size_t>(n) == datagram.bytes.size();
  if (!whole) ++counters_.refused;
  return whole;
}

/// When a recorded packet was measured. Its stamp says it exactly where a master held the clock that wrote
/// it.
std::int64_t LidarDevice::true_ns(std::span<const std::byte> packet, HostTime recorded) const {
  const auto stamp = recorded_stamp(packet);
  const bool exact = stamp && stamp->was_held;
  return (exact ? stamp->stamp_ns : to_ns(recorded)) - *recorded_minus_now_ns_;
}

void LidarDevice::send_data(std::optional<VirtualUnit::Outgoing> packet, std::uint64_t& sent,
                            std::int64_t now) {
  if (!packet || is_pulled(now)) {
    ++counters_.unsent;
  } else if (!is_lost() && send(*packet)) {
    ++sent;
  }
}

void LidarDevice::points(std::span<const std::byte> packet, HostTime recorded) {
  const std::lock_guard lock(mutex_);
  send_data(unit_->points(packet, true_ns(packet, recorded)), counters_.points_sent, now_ns());
}

void LidarDevice::imu(std::span<const std::byte> packet, HostTime recorded) {
  const std::lock_guard lock(mutex_);
  send_data(unit_->imu(packet, true_ns(packet, recorded)), counters_.imu_sent, now_ns());
}

LidarDeviceCounters LidarDevice::counters() const {
  const std::lock_guard lock(mutex_);
  LidarDeviceCounters counters = counters_;
  counters.unit = unit_->counters();
  return counters;
}

}  // namespace edgesplat::virtual_device
