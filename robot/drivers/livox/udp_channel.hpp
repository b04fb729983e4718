// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"
#include "robot/drivers/livox/livox_transport.hpp"

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::livox {

/// One bound UDP socket with its buffers for recvmmsg(). Not movable: the message headers point into it.
class UdpChannel {
 public:
  static constexpr std::size_t kBatch = 64;

  UdpChannel(Channel channel, std::optional<in_addr> only_from) : channel_(channel), only_from_(only_from) {}
  UdpChannel(const UdpChannel&) = delete;
  UdpChannel& operator=(const UdpChannel&) = delete;

  /// `is_shared`: other programs may listen at this port too (broadcasts reach all of them).
  [[nodiscard]] Status open(in_addr address, std::uint16_t port, int receive_buffer_bytes,
                            bool is_shared = false);
  /// What waits in the kernel, without blocking; valid until the next call.
  [[nodiscard]] Result<std::span<const Datagram>> receive(const Clock& clock, TransportCounters& counters);

  /// Sends from `source`, one of this machine's addresses (0.0.0.0: as the route says); false where the
  /// system refused.
  [[nodiscard]] bool send(const Endpoint& to, in_addr source, std::span<const std::byte> bytes) const;

  [[nodiscard]] int fd() const { return socket_.get(); }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] int granted_buffer_bytes() const { return granted_buffer_bytes_; }

 private:
  static constexpr std::size_t kDatagramBytes = 2048;
  static constexpr std::size_t kControlBytes = 128;  // a time stamp and a drop counter
  struct Slot {
    std::array<std::byte, kDatagramBytes> bytes;
    alignas(cmsghdr) std::array<std::byte, kControlBytes> control;
    sockaddr_in sender;
    iovec vector;
  };
  void prepare_slots();
  void note_drops(std::uint32_t total, TransportCounters& counters);

  Channel channel_;
  std::optional<in_addr> only_from_;
  UniqueFd socket_;
  std::uint16_t port_ = 0;
  int granted_buffer_bytes_ = 0;
  std::uint32_t drops_seen_ = 0;
  HostTime newest_arrival_ = HostTime::min();
  std::vector<Slot> slots_;
  std::array<mmsghdr, kBatch> headers_{};
  std::array<Datagram, kBatch> datagrams_{};
};

}  // namespace edgesplat::livox
