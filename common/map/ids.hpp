// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/strong_id.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace edgesplat::map {

/// One robot instance; the same number is the origin of the Gaussians it makes itself.
using RobotId = StrongId<struct RobotTag, std::uint16_t>;
/// Counts the starts of a server: deltas of an older epoch are never applied.
using Epoch = StrongId<struct EpochTag, std::uint32_t>;

/// Name of one map for life (RFC 9562, version 4).
struct MapUuid {
  std::array<std::byte, 16> bytes{};
  bool operator==(const MapUuid&) const = default;
};

}  // namespace edgesplat::map
