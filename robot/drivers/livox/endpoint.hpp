// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace edgesplat::livox {

/// Which of Livox' two protocols a LiDAR speaks.
enum class Protocol : std::uint8_t {
  kSdk1,  ///< Avia, Horizon, Mid-40, Mid-70, Tele-15
  kSdk2,  ///< Mid-360, HAP
};

/// What a UDP socket of the host is for.
enum class Channel : std::uint8_t {
  kPoints,
  kImu,
  kControl,  ///< requests out, answers in; SDK2: discovery too
  kPush,     ///< SDK2: state pushes; SDK1: announcements
};

using Ipv4 = std::array<std::uint8_t, 4>;

/// One end of UDP traffic.
struct Endpoint {
  Ipv4 ip{};
  std::uint16_t port = 0;

  bool operator==(const Endpoint&) const = default;
};

inline constexpr Ipv4 kBroadcast{255, 255, 255, 255};

/// "192.168.1.5"
[[nodiscard]] inline std::string to_string(const Ipv4& ip) {
  return std::to_string(ip[0]) + "." + std::to_string(ip[1]) + "." + std::to_string(ip[2]) + "." +
         std::to_string(ip[3]);
}

}  // namespace edgesplat::livox
