// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/map/keyframe.hpp"
#include "common/map/quantised.hpp"

#include <cstdint>

namespace edgesplat::test {

/// `count` Gaussians with random fields, ids (origin, 1), (origin, 2)..., anchored to keyframe 3.
[[nodiscard]] gaussian::GaussianCloud random_gaussians(std::size_t count, std::uint64_t seed,
                                                       int sh_degree = 0, std::uint16_t origin = 40000);

/// The same as integers, each in the chunk its mean lies in, in the order of chunk and id.
[[nodiscard]] map::QuantisedRows quantised(const gaussian::GaussianCloud& cloud);
/// `count` Gaussians as of random_gaussians(), quantised.
[[nodiscard]] map::QuantisedRows random_rows(std::size_t count, std::uint64_t seed, int sh_degree = 0);

/// A keyframe with everything in it: camera, a few bytes of "image" and random coloured points.
[[nodiscard]] map::Keyframe random_keyframe(std::uint32_t id, std::size_t points, std::uint64_t seed);

/// A keyframe at the origin that looks at a coloured wall of `points` points at x = 3 m, y from `first_y_m`
/// on, 4 m wide.
[[nodiscard]] map::Keyframe wall_keyframe(std::uint32_t id, std::size_t points, double first_y_m = 0.0);

}  // namespace edgesplat::test
