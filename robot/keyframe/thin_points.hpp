// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/keyframe.hpp"

#include <vector>

namespace edgesplat::keyframe {

/// Keeps the first point of each cell of a grid, in order; spacing_m <= 0 keeps all. Points that are not
/// finite or beyond 2^20 cells of the origin are dropped.
[[nodiscard]] std::vector<map::ColouredPoint> thin_points(std::vector<map::ColouredPoint> points,
                                                          float spacing_m);

}  // namespace edgesplat::keyframe
