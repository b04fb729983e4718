// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/noise.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace edgesplat::virtual_device {

/// A bad wire on demand: the same seed spoils the same datagrams. Single-owner.
class FaultInjector {
 public:
  struct Rates {
    double flip = 0.0;  ///< share of datagrams with one bit flipped, [0, 1]
    double drop = 0.0;  ///< share of datagrams lost, [0, 1]
  };
  FaultInjector(Rates rates, std::uint64_t seed) : rates_(rates), seed_(seed) {}

  /// Spoils the datagram in place. False: it is lost.
  bool pass(std::span<std::byte> datagram);
  [[nodiscard]] std::uint64_t flipped() const { return flipped_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  Rates rates_;
  std::uint64_t seed_;
  std::uint64_t next_ = 0;
  std::uint64_t flipped_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace edgesplat::virtual_device
