// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/local_address.hpp"

#include "common/base/unique_fd.hpp"

#include <ifaddrs.h>
#include <net/if.h>
#include <sys/socket.h>

#include <memory>

namespace edgesplat {

std::vector<in_addr> broadcast_sources() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> list(all, &::freeifaddrs);
  std::vector<in_addr> sources;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    constexpr unsigned kNeeded = IFF_UP | IFF_BROADCAST;
    const bool usable = one->ifa_addr != nullptr && one->ifa_addr->sa_family == AF_INET &&
                        (one->ifa_flags & kNeeded) == kNeeded && (one->ifa_flags & IFF_LOOPBACK) == 0;
    if (usable) sources.push_back(reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr);
  }
  return sources;
}

std::optional<in_addr> source_towards(in_addr destination) {
  const UniqueFd fd(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr = destination;
  to.sin_port = htons(9);  // any: nothing is sent
  if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof(to)) != 0) return std::nullopt;
  sockaddr_in from{};
  socklen_t length = sizeof(from);
  if (::getsockname(fd.get(), reinterpret_cast<sockaddr*>(&from), &length) != 0) return std::nullopt;
  return from.sin_addr;
}

}  // namespace edgesplat
