// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/livox_transport.hpp"

#include "common/base/local_address.hpp"
#include "common/thread/stop_fd.hpp"
#include "robot/drivers/livox/udp_channel.hpp"

#include <arpa/inet.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

namespace edgesplat::livox {

namespace {

constexpr std::uint16_t kSdk1AnnouncementPort = 55000;
constexpr int kControlBuffer_bytes = 1 << 17;
constexpr std::size_t kChannels = 4;

in_addr to_in_addr(const Ipv4& ip) {
  in_addr address{};
  std::memcpy(&address, ip.data(), ip.size());
  return address;
}

}  // namespace

class LivoxTransport::Sockets {
 public:
  Sockets(std::optional<in_addr> only_from, const Clock& clock)
      : clock_(clock),
        points_(Channel::kPoints, only_from),
        imu_(Channel::kImu, only_from),
        control_(Channel::kControl, std::nullopt),
        push_(Channel::kPush, std::nullopt) {}

  [[nodiscard]] Status open(const LivoxTransportConfig& config, in_addr address);
  [[nodiscard]] Result<std::span<const Datagram>> receive(const std::stop_token& stop, nanoseconds timeout);
  void send(const Endpoint& to, std::span<const std::byte> bytes);
  [[nodiscard]] std::optional<Ipv4> host_towards(const Ipv4& lidar) const;
  [[nodiscard]] const UdpChannel& points() const { return points_; }
  [[nodiscard]] const UdpChannel& imu() const { return imu_; }
  [[nodiscard]] const UdpChannel& control() const { return control_; }
  [[nodiscard]] const UdpChannel& push() const { return push_; }
  [[nodiscard]] const TransportCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] Result<std::span<const Datagram>> read(std::span<const pollfd> ready);

  const Clock& clock_;
  in_addr address_{};
  std::unique_ptr<thread::StopFd> stop_fd_;
  UdpChannel points_;
  UdpChannel imu_;
  UdpChannel control_;
  UdpChannel push_;
  TransportCounters counters_;
  std::array<Datagram, kChannels * UdpChannel::kBatch> batch_{};
};

Status LivoxTransport::Sockets::open(const LivoxTransportConfig& config, in_addr address) {
  address_ = address;
  EDGESPLAT_TRY_STATUS(points_.open(address, config.points_port, config.receive_buffer_bytes));
  EDGESPLAT_TRY_STATUS(imu_.open(address, config.imu_port, config.receive_buffer_bytes));
  if (!config.control) return {};
  // What is broadcast reaches only sockets that are bound to no address.
  const in_addr any{};
  if (*config.control == Protocol::kSdk1) {
    EDGESPLAT_TRY_STATUS(control_.open(address, config.control_port, kControlBuffer_bytes));
    return push_.open(any, kSdk1AnnouncementPort, kControlBuffer_bytes, true);
  }
  EDGESPLAT_TRY_STATUS(control_.open(any, config.control_port, kControlBuffer_bytes));
  return push_.open(address, config.push_port, kControlBuffer_bytes);
}

Result<std::span<const Datagram>> LivoxTransport::Sockets::receive(const std::stop_token& stop,
                                                                   nanoseconds timeout) {
  if (!stop_fd_ || !stop_fd_->listens_to(stop)) stop_fd_ = std::make_unique<thread::StopFd>(stop);
  if (stop.stop_requested()) return std::span<const Datagram>{};
  std::array<pollfd, kChannels + 1> fds{pollfd{points_.fd(), POLLIN, 0}, pollfd{imu_.fd(), POLLIN, 0},
                                        pollfd{control_.fd(), POLLIN, 0}, pollfd{push_.fd(), POLLIN, 0},
                                        pollfd{stop_fd_->get(), POLLIN, 0}};
  const std::int64_t wait_ms =
      std::clamp<std::int64_t>((timeout.count() + 999'999) / 1'000'000, 0, std::numeric_limits<int>::max());
  const int ready = ::poll(fds.data(), fds.size(), static_cast<int>(wait_ms));
  if (ready < 0 && errno != EINTR)
    return fail(Errc::kIo, "cannot wait for LiDAR packets: " + std::generic_category().message(errno));
  if (ready <= 0 || fds.back().revents != 0) return std::span<const Datagram>{};
  return read(fds);
}

Result<std::span<const Datagram>> LivoxTransport::Sockets::read(std::span<const pollfd> ready) {
  const auto waiting = [&](std::size_t i) { return ready[i].revents != 0; };
  std::span<const Datagram> points, imu;
  if (waiting(0)) {
    EDGESPLAT_TRY(points, points_.receive(clock_, counters_));
  }
  if (waiting(1)) {
    EDGESPLAT_TRY(imu, imu_.receive(clock_, counters_));
  }
  const auto earlier = [](const Datagram& a, const Datagram& b) { return a.arrival < b.arrival; };
  auto end = std::merge(points.begin(), points.end(), imu.begin(), imu.end(), batch_.begin(), earlier);
  if (waiting(2)) {
    EDGESPLAT_TRY(const auto answers, control_.receive(clock_, counters_));
    end = std::copy(answers.begin(), answers.end(), end);
  }
  if (waiting(3)) {
    EDGESPLAT_TRY(const auto pushes, push_.receive(clock_, counters_));
    end = std::copy(pushes.begin(), pushes.end(), end);
  }
  return std::span<const Datagram>(batch_.begin(), end);
}

void LivoxTransport::Sockets::send(const Endpoint& to, std::span<const std::byte> bytes) {
  bool sent = false;
  if (to.ip == kBroadcast && address_.s_addr == INADDR_ANY) {
    for (const in_addr source : broadcast_sources()) sent = control_.send(to, source, bytes) || sent;
  } else {
    sent = control_.send(to, address_, bytes);
  }
  if (!sent) ++counters_.send_failures;
}

std::optional<Ipv4> LivoxTransport::Sockets::host_towards(const Ipv4& lidar) const {
  const auto source =
      address_.s_addr != INADDR_ANY ? std::optional(address_) : source_towards(to_in_addr(lidar));
  if (!source) return std::nullopt;
  Ipv4 ip{};
  std::memcpy(ip.data(), &*source, ip.size());
  return ip;
}

namespace {

Result<in_addr> parse_ipv4(const std::string& text, const char* what) {
  in_addr address{};
  if (::inet_pton(AF_INET, text.c_str(), &address) != 1)
    return fail(Errc::kInvalidConfig, std::string("the LiDAR's ") + what + " '" + text +
                                          "' is no IPv4 address such as 192.168.1.5");
  return address;
}

}  // namespace

Result<LivoxTransport> LivoxTransport::open(const LivoxTransportConfig& config, const Clock& clock) {
  EDGESPLAT_TRY(const in_addr address, parse_ipv4(config.bind_address, "bind_address"));
  std::optional<in_addr> only_from;
  if (!config.lidar_address.empty()) {
    EDGESPLAT_TRY(only_from, parse_ipv4(config.lidar_address, "lidar_address"));
  }
  if (config.points_port == config.imu_port && config.points_port != 0)
    return fail(Errc::kInvalidConfig, "the LiDAR's points_port and imu_port are both " +
                                          std::to_string(config.points_port) + "; they must differ");
  auto sockets = std::make_unique<Sockets>(only_from, clock);
  EDGESPLAT_TRY_STATUS(sockets->open(config, address));
  return LivoxTransport(std::move(sockets));
}

LivoxTransport::LivoxTransport(std::unique_ptr<Sockets> sockets) : sockets_(std::move(sockets)) {}
LivoxTransport::LivoxTransport(LivoxTransport&&) noexcept = default;
LivoxTransport& LivoxTransport::operator=(LivoxTransport&&) noexcept = default;
LivoxTransport::~LivoxTransport() = default;

void LivoxTransport::send(const Endpoint& to, std::span<const std::byte> bytes) {
  sockets_->send(to, bytes);
}
std::optional<Ipv4> LivoxTransport::host_towards(const Ipv4& lidar) const {
  return sockets_->host_towards(lidar);
}
std::uint16_t LivoxTransport::control_port() const {
  return sockets_->control().port();
}
std::uint16_t LivoxTransport::push_port() const {
  return sockets_->push().port();
}

Result<std::span<const Datagram>> LivoxTransport::receive(const std::stop_token& stop, nanoseconds timeout) {
  return sockets_->receive(stop, timeout);
}
int LivoxTransport::receive_buffer_bytes() const {
  return std::min(sockets_->points().granted_buffer_bytes(), sockets_->imu().granted_buffer_bytes());
}
std::uint16_t LivoxTransport::points_port() const {
  return sockets_->points().port();
}
std::uint16_t LivoxTransport::imu_port() const {
  return sockets_->imu().port();
}
const TransportCounters& LivoxTransport::counters() const {
  return sockets_->counters();
}

}  // namespace edgesplat::livox
