// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::livox {

/// A program that has a UDP port open.
struct PortHolder {
  int pid = 0;
  std::string program;  ///< as ps names it
};

/// Who holds the UDP port on this machine, by /proc/net/udp and /proc/<pid>/fd. Nothing where no other
/// program does or it belongs to another user. Costs some ms: for messages only.
[[nodiscard]] std::optional<PortHolder> find_port_holder(std::uint16_t port);
/// Socket inodes of the lines of a /proc/net/udp table with this local port.
[[nodiscard]] std::vector<std::string> inodes_of_port(std::string_view udp_table, std::uint16_t port);

}  // namespace edgesplat::livox
