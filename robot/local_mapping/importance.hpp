// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::local_mapping {

/// The `count` rows that a robot at `near_m` (same frame) misses least, ascending: opacity times the largest
/// face of the Gaussian over its distance squared, that is, how much it fills of a picture taken there. Of
/// equals the older goes. All rows where there are not more. O(n).
[[nodiscard]] std::vector<std::uint32_t> least_important(const gaussian::GaussianCloud& cloud,
                                                         const Eigen::Vector3f& near_m, std::size_t count);

}  // namespace edgesplat::local_mapping
