// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world.hpp"
#include "tools/simulate/world/scene.hpp"
#include "tools/simulate/world/stored_light.hpp"

namespace edgesplat::simulate {

/// Radiance of the sky, below 1.
[[nodiscard]] Rgb sky_radiance(const Eigen::Vector3d& direction);

/// Radiance of a surface of `material` under `light` towards the ray's origin.
[[nodiscard]] Rgb surface_radiance(const Material& material, const Ray& ray, const Hit& hit, const Rgb& light,
                                   double footprint_m);

}  // namespace edgesplat::simulate
