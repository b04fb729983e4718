// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/unique_fd.hpp"
#include "common/time/time.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <stop_token>
#include <string>

namespace edgesplat::aravis {

/// GigE Vision's discovery command, which every camera answers whoever controls it (GVCP on UDP port 3956).
inline constexpr std::array<std::byte, 8> kDiscoveryCommand{
    std::byte{0x42}, std::byte{0x01}, std::byte{0x00}, std::byte{0x02},   // command, answer wanted; discovery
    std::byte{0x00}, std::byte{0x00}, std::byte{0x00}, std::byte{0x01}};  // no payload; id 1
[[nodiscard]] bool is_discovery_answer(std::span<const std::byte> datagram);

/// Asks a camera whether it is there, in milliseconds: libaravis would wait for seconds. Thread-bound.
class GvcpProbe {
 public:
  /// `address` is the camera's IPv4 address; for anything else the answer is always no.
  explicit GvcpProbe(const std::string& address);
  /// Sends the question and waits for the answer.
  [[nodiscard]] bool answers(const std::stop_token& stop, nanoseconds timeout) const;

 private:
  UniqueFd socket_;  ///< connected to the camera
};

}  // namespace edgesplat::aravis
