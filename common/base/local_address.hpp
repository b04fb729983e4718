// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>

#include <optional>
#include <vector>

namespace edgesplat {

/// This machine's addresses on networks that take broadcasts (not loopback). For each a broadcast has to be
/// sent: the kernel sends one to 255.255.255.255 on one network only.
[[nodiscard]] std::vector<in_addr> broadcast_sources();
/// The address that this machine sends from to `destination`; nothing where no way leads there.
[[nodiscard]] std::optional<in_addr> source_towards(in_addr destination);

}  // namespace edgesplat
