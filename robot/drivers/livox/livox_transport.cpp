// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/livox_transport.hpp"

#include "common/thread/stop_fd.hpp"
#include "robot/drivers/livox/udp_channel.hpp"

#include <arpa/inet.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

namespace edgesplat::livox {

class LivoxTransport::Sockets {
 public:
  Sockets(std::optional<in_addr> only_from, const Clock& clock)
      : clock_(clock), points_(Channel::kPoints, only_from), imu_(Channel::kImu, only_from) {}

  [[nodiscard]] Status open(const LivoxTransportConfig& config, in_addr address) {
    EDGESPLAT_TRY_STATUS(points_.open(address, config.points_port, config.receive_buffer_bytes));
    return imu_.open(address, config.imu_port, config.receive_buffer_bytes);
  }
  [[nodiscard]] Result<std::span<const Datagram>> receive(const std::stop_token& stop, nanoseconds timeout);
  [[nodiscard]] const UdpChannel& points() const { return points_; }
  [[nodiscard]] const UdpChannel& imu() const { return imu_; }
  [[nodiscard]] const TransportCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] Result<std::span<const Datagram>> read_both();

  const Clock& clock_;
  std::unique_ptr<thread::StopFd> stop_fd_;
  UdpChannel points_;
  UdpChannel imu_;
  TransportCounters counters_;
  std::array<Datagram, 2 * UdpChannel::kBatch> batch_{};
};

Result<std::span<const Datagram>> LivoxTransport::Sockets::receive(const std::stop_token& stop,
                                                                   nanoseconds timeout) {
  if (!stop_fd_ || !stop_fd_->listens_to(stop)) stop_fd_ = std::make_unique<thread::StopFd>(stop);
  if (stop.stop_requested()) return std::span<const Datagram>{};
  std::array<pollfd, 3> fds{pollfd{stop_fd_->get(), POLLIN, 0}, pollfd{points_.fd(), POLLIN, 0},
                            pollfd{imu_.fd(), POLLIN, 0}};
  const std::int64_t wait_ms =
      std::clamp<std::int64_t>((timeout.count() + 999'999) / 1'000'000, 0, std::numeric_limits<int>::max());
  const int ready = ::poll(fds.data(), fds.size(), static_cast<int>(wait_ms));
  if (ready < 0 && errno != EINTR)
    return fail(Errc::kIo, "cannot wait for LiDAR packets: " + std::generic_category().message(errno));
  if (ready <= 0 || fds[0].revents != 0) return std::span<const Datagram>{};
  return read_both();
}

Result<std::span<const Datagram>> LivoxTransport::Sockets::read_both() {
  EDGESPLAT_TRY(const auto points, points_.receive(clock_, counters_));
  EDGESPLAT_TRY(const auto imu, imu_.receive(clock_, counters_));
  const auto earlier = [](const Datagram& a, const Datagram& b) { return a.arrival < b.arrival; };
  std::merge(points.begin(), points.end(), imu.begin(), imu.end(), batch_.begin(), earlier);
  return std::span<const Datagram>(batch_).first(points.size() + imu.size());
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
