// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/curve.hpp"

#include <gtest/gtest.h>

namespace edgesplat::simulate {
namespace {

const Polyline kSquare{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};

TEST(Curve, ResamplesEvenlyAroundCorners) {
  const Polyline points = resample(kSquare, true, 0.3);
  EXPECT_NEAR(static_cast<double>(points.size()), 40.0 / 0.3, 1.0);
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LE((points[i] - points[i - 1]).norm(), 0.3 + 1e-9);
}

TEST(Curve, SmoothingRoundsCornersAndLeavesStraights) {
  const Polyline smooth = smooth_closed(kSquare, 1.0);
  double nearest_corner = 1e9;
  for (const auto& p : smooth) nearest_corner = std::min(nearest_corner, p.norm());
  EXPECT_NEAR(nearest_corner, 0.25 * std::sqrt(2.0), 0.02);
  EXPECT_NEAR(smooth[50].y(), 0.0, 1e-12);
}

TEST(Curve, OffsetGoesToTheLeft) {
  const Polyline inner = offset_left(resample(kSquare, true, 0.5), true, 1.0);
  EXPECT_NEAR(inner[10].y(), 1.0, 1e-9);  // counter-clockwise: left is inside
  const Polyline line = offset_left({{0, 0, 0}, {5, 0, 0}}, false, -2.0);
  EXPECT_NEAR(line[1].y(), -2.0, 1e-12);
}

}  // namespace
}  // namespace edgesplat::simulate
