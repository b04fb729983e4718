// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <vector>

namespace edgesplat::test {

/// Root mean square distance of places, in metres, after the rigid motion that makes it least. As many of one
/// as of the other, at least one.
[[nodiscard]] double absolute_error_m(const std::vector<Eigen::Vector3d>& estimate,
                                      const std::vector<Eigen::Vector3d>& truth);

}  // namespace edgesplat::test
