// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/fault_injector.hpp"

namespace edgesplat::virtual_device {

bool FaultInjector::pass(std::span<std::byte> datagram) {
  simulate::NoiseStream noise(seed_, simulate::NoisePurpose::kStreamFault, next_++);
  if (noise.uniform() < rates_.drop) {
    ++dropped_;
    return false;
  }
  if (noise.uniform() < rates_.flip && !datagram.empty()) {
    const std::uint64_t bit = noise.bits() % (8 * datagram.size());
    datagram[bit / 8] ^= std::byte{1} << (bit % 8);
    ++flipped_;
  }
  return true;
}

}  // namespace edgesplat::virtual_device
