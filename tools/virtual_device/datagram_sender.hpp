// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"

#include <netinet/in.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace edgesplat::virtual_device {

/// Sends UDP datagrams to one place. Single-owner.
class DatagramSender {
 public:
  /// `address` is a numeric IPv4 address. kInvalidConfig, kIo.
  static Result<DatagramSender> open(const std::string& address, std::uint16_t port);
  /// False where the system refused (buffers full, no route): counted, not fatal, as on a real wire.
  bool send(std::span<const std::byte> datagram);
  [[nodiscard]] std::uint64_t sent() const { return sent_; }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  DatagramSender(UniqueFd socket, const sockaddr_in& to) : socket_(std::move(socket)), to_(to) {}
  UniqueFd socket_;
  sockaddr_in to_;
  std::uint64_t sent_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace edgesplat::virtual_device
