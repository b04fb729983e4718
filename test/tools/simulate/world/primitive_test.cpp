// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/primitive.hpp"

#include "test/tools/simulate/world/random_rays.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <utility>

namespace edgesplat::simulate {
namespace {

using Eigen::Vector3d;

constexpr double kFar = 100.0;

Primitive make(Shape shape, const Vector3d& half) {
  Primitive p;
  p.shape = shape;
  p.half_m = half;
  return p;
}

double cast(const Primitive& p, const Vector3d& origin, const Vector3d& direction) {
  return intersect(p, origin, direction.normalized(), kNearestRange_m, kFar);
}

TEST(Primitive, BoxIsHitAtItsFaceAndFromInsideAtTheFarOne) {
  const Primitive box = make(Shape::kBox, {1, 2, 3});
  EXPECT_DOUBLE_EQ(cast(box, {5, 0.5, 0}, {-1, 0, 0}), 4.0);
  EXPECT_DOUBLE_EQ(cast(box, {0, 0, 0}, {0, 1, 0}), 2.0);
  EXPECT_DOUBLE_EQ(cast(box, {5, 2.01, 0}, {-1, 0, 0}), kFar);
  EXPECT_DOUBLE_EQ(cast(box, {5, 0, 0}, {1, 0, 0}), kFar);
}

TEST(Primitive, QuadIsHitFromBothSides) {
  const Primitive quad = make(Shape::kQuad, {1, 2, 0});
  EXPECT_DOUBLE_EQ(cast(quad, {0.5, 1.5, 3}, {0, 0, -1}), 3.0);
  EXPECT_DOUBLE_EQ(cast(quad, {0.5, 1.5, -3}, {0, 0, 1}), 3.0);
  EXPECT_DOUBLE_EQ(cast(quad, {1.5, 0, 3}, {0, 0, -1}), kFar);
}

TEST(Primitive, CylinderHasSideAndEndsATubeOnlyASide) {
  const Primitive cylinder = make(Shape::kCylinder, {0.5, 0.5, 2});
  EXPECT_NEAR(cast(cylinder, {3, 0.3, 1}, {-1, 0, 0}), 3.0 - 0.4, 1e-12);
  EXPECT_NEAR(cast(cylinder, {0.1, 0.1, 5}, {0, 0, -1}), 3.0, 1e-12);
  const Primitive tube = make(Shape::kTube, {0.5, 0.5, 2});
  EXPECT_DOUBLE_EQ(cast(tube, {0.1, 0.1, 5}, {0, 0, -1}), kFar);
  EXPECT_NEAR(cast(tube, {0, 0, 0}, {1, 0, 0}), 0.5, 1e-12);
}

TEST(Primitive, EllipsoidAndCapsuleAreHitWhereTheirEquationsSay) {
  EXPECT_NEAR(cast(make(Shape::kEllipsoid, {1, 2, 3}), {0, 0, 10}, {0, 0, -1}), 7.0, 1e-12);
  EXPECT_NEAR(cast(make(Shape::kEllipsoid, {2, 2, 2}), {5, 1, 0}, {-1, 0, 0}), 5.0 - std::sqrt(3.0), 1e-12);
  const Primitive capsule = make(Shape::kCapsule, {0.5, 0.5, 1});
  EXPECT_NEAR(cast(capsule, {0, 0, 5}, {0, 0, -1}), 3.5, 1e-12);
  EXPECT_NEAR(cast(capsule, {4, 0, 0.5}, {-1, 0, 0}), 3.5, 1e-12);
  EXPECT_NEAR(cast(capsule, {4, 0, 1.3}, {-1, 0, 0}), 4.0 - 0.4, 1e-12);
  EXPECT_DOUBLE_EQ(cast(capsule, {4, 0, 1.6}, {-1, 0, 0}), kFar);
}

TEST(Primitive, TaperedBoxLeansInwards) {
  Primitive box = make(Shape::kTaperedBox, {1, 1, 1});
  box.top_scale = {0.5, 0.5};
  box.top_shift_m = 0.2;
  // Half way up, x runs from (-1 + -0.3) / 2 to (1 + 0.7) / 2.
  EXPECT_NEAR(cast(box, {5, 0, 0}, {-1, 0, 0}), 5.0 - 0.85, 1e-12);
  EXPECT_NEAR(cast(box, {-5, 0, 0}, {1, 0, 0}), 5.0 - 0.65, 1e-12);
  EXPECT_NEAR(cast(box, {0, 5, 0}, {0, -1, 0}), 5.0 - 0.75, 1e-12);
}

class EveryShape : public testing::TestWithParam<Shape> {
 protected:
  EveryShape() {
    primitive_ = make(GetParam(),
                      {0.7, GetParam() == Shape::kEllipsoid || GetParam() == Shape::kBox ? 0.9 : 0.7, 1.1});
    if (GetParam() == Shape::kTaperedBox) primitive_.top_scale = {0.6, 0.8};
    primitive_.centre_m = {0.3, -0.2, 0.5};
    primitive_.rotate(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix());
  }
  Primitive primitive_;
};

TEST_P(EveryShape, HitsLieInTheBoundsAndBackOnTheSurface) {
  RandomRays rays(3);
  const Bounds box = bounds(primitive_);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d origin = rays.point(4.0), direction = rays.direction();
    const double t = intersect(primitive_, origin, direction, kNearestRange_m, kFar);
    if (t >= kFar) continue;
    ++hits;
    const Vector3d p = origin + t * direction;
    EXPECT_TRUE(((p - box.lo_m).array() > -1e-9).all() && ((box.hi_m - p).array() > -1e-9).all());
    const SurfacePoint at = surface_at(primitive_, p);
    EXPECT_NEAR(at.normal.norm(), 1.0, 1e-9);
    const Eigen::Vector2d size = face_size_m(primitive_, at.face);
    EXPECT_TRUE((at.uv_m.array() >= 0.0).all() && (at.uv_m.array() <= size.array() + 1e-9).all());
    EXPECT_LT((face_point(primitive_, at.face, at.uv_m).p_in_world_m - p).norm(), 1e-6);
  }
  EXPECT_GT(hits, 200);
}

TEST_P(EveryShape, NormalsPointOutOfSolidsAndIntoATube) {
  RandomRays rays(4);
  for (int i = 0; i < 5000; ++i) {
    const Vector3d target = primitive_.centre_m + 0.3 * rays.direction();
    const Vector3d direction = rays.direction(), origin = target - 6.0 * direction;
    const double t = intersect(primitive_, origin, direction, kNearestRange_m, kFar);
    if (t >= kFar || GetParam() == Shape::kQuad) continue;
    const double facing = surface_at(primitive_, origin + t * direction).normal.dot(direction);
    if (GetParam() != Shape::kTube) {
      EXPECT_LE(facing, 1e-6);
    }
  }
}

std::string shape_name(const testing::TestParamInfo<Shape>& shape) {
  static constexpr const char* kNames[] = {"Box",  "TaperedBox", "Quad",   "Cylinder",
                                           "Tube", "Ellipsoid",  "Capsule"};
  return kNames[static_cast<int>(shape.param)];
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape,
                         testing::Values(Shape::kBox, Shape::kTaperedBox, Shape::kQuad, Shape::kCylinder,
                                         Shape::kTube, Shape::kEllipsoid, Shape::kCapsule),
                         shape_name);

}  // namespace
}  // namespace edgesplat::simulate
