// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/time/clock.hpp"
#include "robot/drivers/livox/endpoint.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>

namespace edgesplat::livox {

struct LivoxTransportConfig {
  std::string bind_address =
      "0.0.0.0";                       ///< IPv4 address of the network card towards the LiDAR; 0.0.0.0 = all
  std::uint16_t points_port = 56301;   ///< 0 = any free one
  std::uint16_t imu_port = 56401;      ///< 0 = any free one
  std::string lidar_address;           ///< only datagrams from this IPv4 address; empty = from everywhere
  std::optional<Protocol> control;     ///< empty: the LiDAR is listened to, but not spoken with
  std::uint16_t control_port = 56101;  ///< 0 = any free one
  std::uint16_t push_port = 56201;     ///< SDK2: 0 = any free one; SDK1: its announcements come to 55000
  int receive_buffer_bytes = 4 << 20;  ///< asked of the kernel: 1.4 s of a Mid-360, [64 Ki, 256 Mi]
};

/// One UDP payload, borrowed from the transport until the next receive().
struct Datagram {
  Channel channel = Channel::kPoints;
  HostTime arrival{};
  std::span<const std::byte> bytes;
  Endpoint from{};
};

struct TransportCounters {
  std::uint64_t datagrams = 0;
  std::uint64_t foreign = 0;         ///< from another address than lidar_address: dropped
  std::uint64_t send_failures = 0;   ///< requests that the system refused: no network
  std::uint64_t kernel_dropped = 0;  ///< the receive buffer was full: this program was too slow
};

/// The UDP sockets of a Livox sensor: points and IMU, with `control` also commands and states. Arrival is the
/// kernel's stamp of the datagram (SO_TIMESTAMPNS, on the wall clock), carried over to the program's clock by
/// its age: a step of the wall clock changes nothing, a busy program does not shift arrivals. Those of a
/// channel never go back. Thread-bound (one thread calls receive()); no allocation after open().
class LivoxTransport {
 public:
  /// kIo where a port is taken, with the program that holds it; kInvalidConfig for addresses that are none.
  /// `clock` must outlive the transport.
  static Result<LivoxTransport> open(const LivoxTransportConfig& config, const Clock& clock);
  LivoxTransport(LivoxTransport&&) noexcept;
  LivoxTransport& operator=(LivoxTransport&&) noexcept;
  LivoxTransport(const LivoxTransport&) = delete;
  LivoxTransport& operator=(const LivoxTransport&) = delete;
  ~LivoxTransport();

  /// Waits for datagrams and gives a batch, oldest first. Empty when `stop` is requested or `timeout` has
  /// passed.
  [[nodiscard]] Result<std::span<const Datagram>> receive(const std::stop_token& stop, nanoseconds timeout);

  /// A request to a LiDAR, or to everyone on the networks of bind_address (kBroadcast). Precondition:
  /// control.
  void send(const Endpoint& to, std::span<const std::byte> bytes);
  /// This machine's address as a LiDAR sees it.
  [[nodiscard]] std::optional<Ipv4> host_towards(const Ipv4& lidar) const;

  /// What the kernel granted; less than asked loses packets while the program is busy (raise
  /// net.core.rmem_max).
  [[nodiscard]] int receive_buffer_bytes() const;
  [[nodiscard]] std::uint16_t points_port() const;
  [[nodiscard]] std::uint16_t imu_port() const;
  [[nodiscard]] std::uint16_t control_port() const;
  [[nodiscard]] std::uint16_t push_port() const;
  [[nodiscard]] const TransportCounters& counters() const;

 private:
  class Sockets;
  explicit LivoxTransport(std::unique_ptr<Sockets> sockets);
  std::unique_ptr<Sockets> sockets_;
};

}  // namespace edgesplat::livox
