// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/rigid_transform.hpp"

#include <gmock/gmock.h>

namespace edgesplat::test {

/// `EXPECT_THAT(matrix, IsNear(expected, 1e-9));` every coefficient within `tolerance`.
MATCHER_P2(IsNear, expected, tolerance, "is near the expected matrix") {
  const double error = (arg - expected).cwiseAbs().maxCoeff();
  *result_listener << "largest difference " << error << ", expected\n" << expected << "\nis\n" << arg;
  return error <= tolerance;  // false for NaN, too
}

/// Rotation within `rotation_rad` and translation within `translation_m`.
MATCHER_P3(IsNearTransform, expected, rotation_rad, translation_m, "is near the expected transform") {
  const double angle = arg.rotation.angularDistance(expected.rotation);
  const double distance = (arg.translation_m - expected.translation_m).norm();
  *result_listener << "off by " << angle << " rad and " << distance << " m";
  return angle <= rotation_rad && distance <= translation_m;
}

}  // namespace edgesplat::test
