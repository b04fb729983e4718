// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world/scene.hpp"

#include <cstdint>

namespace edgesplat::simulate {

/// The places by name, each a pure function of the seed.
[[nodiscard]] Scene make_corridor(std::uint64_t seed);
[[nodiscard]] Scene make_street(std::uint64_t seed);
[[nodiscard]] Scene make_tunnel(std::uint64_t seed);
[[nodiscard]] Scene make_square(std::uint64_t seed);

}  // namespace edgesplat::simulate
