// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world/scene.hpp"

#include <cstdint>

namespace edgesplat::simulate {

/// The places by name, each a pure function of the seed.
[[nodiscard]] Scene make_corridor(std::uint64_t seed);
/// The same walls with nothing on them: even paint, nothing for a camera to hold on to but edges.
[[nodiscard]] Scene make_bare_corridor();
/// A corridor 300 m around.
[[nodiscard]] Scene make_loop(std::uint64_t seed);
[[nodiscard]] Scene make_stairs(std::uint64_t seed);
[[nodiscard]] Scene make_street(std::uint64_t seed);
[[nodiscard]] Scene make_tunnel(std::uint64_t seed);
[[nodiscard]] Scene make_square(std::uint64_t seed);

}  // namespace edgesplat::simulate
