// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <vector>

namespace edgesplat::simulate {

using Polyline = std::vector<Eigen::Vector3d>;

/// Points every `spacing_m` along a polyline; a closed one does not repeat its first point.
[[nodiscard]] Polyline resample(const Polyline& line, bool closed, double spacing_m);
/// Mean of a closed polyline over +-reach_m of its length: rounds corners.
[[nodiscard]] Polyline smooth_closed(const Polyline& line, double reach_m);
/// The line moved to the left by `left_m` (negative: right), seen from above.
[[nodiscard]] Polyline offset_left(const Polyline& line, bool closed, double left_m);

}  // namespace edgesplat::simulate
