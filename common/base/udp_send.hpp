// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>

#include <cstddef>
#include <span>

namespace edgesplat {

/// One datagram, sent from the local address `source` (INADDR_ANY: as the route says), which a socket bound
/// to all addresses cannot say otherwise. Never waits. False where it was not sent whole.
[[nodiscard]] bool send_datagram(int socket, const sockaddr_in& to, in_addr source,
                                 std::span<const std::byte> bytes);

}  // namespace edgesplat
