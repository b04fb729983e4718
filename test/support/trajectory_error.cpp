// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/trajectory_error.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace edgesplat::test {

double absolute_error_m(const std::vector<Eigen::Vector3d>& estimate,
                        const std::vector<Eigen::Vector3d>& truth) {
  const auto columns = [](const std::vector<Eigen::Vector3d>& points) {
    return Eigen::Map<const Eigen::Matrix3Xd>(points.front().data(), 3,
                                              static_cast<Eigen::Index>(points.size()));
  };
  const Eigen::Matrix4d aligned = Eigen::umeyama(columns(estimate), columns(truth), false);
  const Eigen::Matrix3Xd moved = (aligned.topLeftCorner<3, 3>() * columns(estimate)).colwise() +
                                 Eigen::Vector3d(aligned.topRightCorner<3, 1>());
  return std::sqrt((moved - columns(truth)).colwise().squaredNorm().mean());
}

}  // namespace edgesplat::test
