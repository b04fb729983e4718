// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/camera_model.hpp"

#include "test/support/eigen_matchers.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace edgesplat::geometry {
namespace {

using test::IsNear;

CameraModel pinhole(std::array<double, 4> distortion = {}) {
  return {CameraKind::kPinhole, 640, 512, 420.0, 425.0, 321.3, 254.8, distortion};
}
CameraModel pinhole_k3(std::array<double, 4> distortion, double k3) {
  CameraModel camera = pinhole(distortion);
  camera.k3 = k3;
  return camera;
}
CameraModel fisheye(std::array<double, 4> distortion = {}) {
  return {CameraKind::kFisheye, 800, 800, 220.0, 221.0, 399.5, 400.5, distortion};
}

std::vector<CameraModel> sample_cameras() {
  return {pinhole(),
          pinhole({-0.28, 0.07, 0.0002, -0.0004}),
          pinhole({0.1, 0.02, -0.001, 0.001}),
          pinhole_k3({-0.30, 0.11, 0.0003, -0.0002}, -0.019),
          fisheye(),
          fisheye({0.02, -0.004, 0.0003, 0.0})};
}

TEST(CameraModel, PinholeProjectsByHand) {
  const auto pixel = pinhole().project({0.5, -0.25, 2.0});
  ASSERT_TRUE(pixel);
  EXPECT_THAT(*pixel, IsNear(Eigen::Vector2d(420.0 * 0.25 + 321.3, 425.0 * -0.125 + 254.8), 1e-12));
}

TEST(CameraModel, DistortionFollowsOpenCv) {
  // x = 0.2, y = -0.1: r2 = 0.05; values of OpenCV's documented formula worked out by hand.
  const double radial = 1.0 + 0.05 * -0.3 + 0.0025 * 0.1;
  const double x = 0.2 * radial + 2.0 * 0.01 * 0.2 * -0.1 + 0.02 * (0.05 + 2.0 * 0.04);
  const double y = -0.1 * radial + 0.01 * (0.05 + 2.0 * 0.01) + 2.0 * 0.02 * 0.2 * -0.1;
  const auto pixel = pinhole({-0.3, 0.1, 0.01, 0.02}).project({0.2, -0.1, 1.0});
  ASSERT_TRUE(pixel);
  EXPECT_THAT(*pixel, IsNear(Eigen::Vector2d(420.0 * x + 321.3, 425.0 * y + 254.8), 1e-10));
}

TEST(CameraModel, ThirdRadialTermFollowsOpenCv) {
  // The same point; k3 r^6 = 40 * 0.000125 more of x and y.
  const auto without = pinhole({-0.3, 0.1, 0.01, 0.02}).project({0.2, -0.1, 1.0});
  const auto with = pinhole_k3({-0.3, 0.1, 0.01, 0.02}, 40.0).project({0.2, -0.1, 1.0});
  ASSERT_TRUE(without && with);
  EXPECT_THAT(Eigen::Vector2d(*with - *without),
              IsNear(Eigen::Vector2d(420.0 * 0.2 * 0.005, 425.0 * -0.1 * 0.005), 1e-10));
  EXPECT_TRUE(pinhole_k3({}, 0.1).has_distortion());
  EXPECT_TRUE(pinhole({0.0, 0.0, 0.0, 0.1}).has_distortion());
  EXPECT_FALSE(pinhole().has_distortion());
}

TEST(CameraModel, UnprojectUndoesProjectEverywhereInThePicture) {
  for (const CameraModel& camera : sample_cameras()) {
    for (int y = 0; y < camera.height_px; y += 37) {
      for (int x = 0; x < camera.width_px; x += 41) {
        const Eigen::Vector3d ray = camera.unproject({x, y});
        EXPECT_NEAR(ray.norm(), 1.0, 1e-12);
        const auto pixel = camera.project(3.0 * ray);
        ASSERT_TRUE(pixel) << x << " " << y;
        EXPECT_THAT(*pixel, IsNear(Eigen::Vector2d(x, y), 1e-7));
      }
    }
  }
}

TEST(CameraModel, FisheyeSeesBehindItself) {
  const CameraModel camera = fisheye({0.01, 0.0, 0.0, 0.0});
  const double theta = 110.0 * std::numbers::pi / 180.0;
  const Eigen::Vector3d ray(std::sin(theta) * 0.6, std::sin(theta) * 0.8, std::cos(theta));
  ASSERT_LT(ray.z(), 0.0);
  const auto pixel = camera.project(5.0 * ray);
  ASSERT_TRUE(pixel);
  EXPECT_THAT(camera.unproject(*pixel), IsNear(ray, 1e-9));
}

TEST(CameraModel, FisheyeAxisIsTheCentreAndItsOppositeIsNot) {
  const auto ahead = fisheye().project({0.0, 0.0, 2.0});
  ASSERT_TRUE(ahead);
  EXPECT_THAT(*ahead, IsNear(Eigen::Vector2d(399.5, 400.5), 1e-12));
  EXPECT_FALSE(fisheye().project({0.0, 0.0, -2.0}));
  EXPECT_FALSE(fisheye().project({0.0, 0.0, 0.0}));
}

TEST(CameraModel, PinholeDoesNotSeeBehindItself) {
  EXPECT_FALSE(pinhole().project({0.1, 0.1, -1.0}));
  EXPECT_FALSE(pinhole().project({0.1, 0.1, 0.0}));
}

TEST(CameraModel, RejectsWhatLiesBeyondTheFold) {
  // r (1 - 0.3 r^2) grows until r = 1.054 and is negative from r = 1.826 on, where it would be mirrored.
  const CameraModel barrel = pinhole({-0.3, 0.0, 0.0, 0.0});
  EXPECT_TRUE(barrel.project({1.0, 0.0, 1.0}));
  for (const double r : {1.1, 1.5, 1.9, 3.0, 100.0}) {
    EXPECT_FALSE(barrel.project({r, 0.0, 1.0})) << r;
    EXPECT_FALSE(barrel.project({0.0, -r, 1.0})) << r;
  }
  // 1 - 1.2 s + 0.25 s^2 falls below zero between s = 1.07 and 3.7 and grows again: still beyond the fold.
  const CameraModel wavy = pinhole({-0.4, 0.05, 0.0, 0.0});
  EXPECT_TRUE(wavy.project({1.0, 0.0, 1.0}));
  EXPECT_FALSE(wavy.project({1.5, 0.0, 1.0}));
  EXPECT_FALSE(wavy.project({3.0, 0.0, 1.0}));
  // With k3: 1 + 7 k3 s^3 alone is zero at s = 1; and where k3 makes a polynomial grow that folded without
  // it.
  EXPECT_TRUE(pinhole_k3({}, -1.0 / 7.0).project({0.99, 0.0, 1.0}));
  EXPECT_FALSE(pinhole_k3({}, -1.0 / 7.0).project({1.01, 0.0, 1.0}));
  EXPECT_TRUE(pinhole_k3({-0.4, 0.05, 0.0, 0.0}, 0.1).project({1.5, 0.0, 1.0}));
}

/// Against the slope itself at a thousand places from the centre to the point.
TEST(CameraModel, FoldIsFoundWhereTheSlopeIsNoLongerPositive) {
  test::Random random(11);
  int folded = 0;
  for (int i = 0; i < 2000; ++i) {
    const double k1 = random.uniform(-1.0, 1.0), k2 = random.uniform(-1.0, 1.0);
    const double k3 = i % 3 == 0 ? 0.0 : random.uniform(-1.0, 1.0);
    const double r = random.uniform(0.1, 2.0);
    double least = 1.0;
    for (int step = 0; step <= 1000; ++step) {
      const double at = r * step / 1000.0, s = at * at;
      least = std::min(least, 1.0 + s * (3.0 * k1 + s * (5.0 * k2 + s * 7.0 * k3)));
    }
    if (std::abs(least) < 1e-3) continue;  // a thousand places do not tell
    EXPECT_EQ(pinhole_k3({k1, k2, 0.0, 0.0}, k3).project({r, 0.0, 1.0}).has_value(), least > 0.0)
        << k1 << " " << k2 << " " << k3 << " " << r;
    folded += least <= 0.0 ? 1 : 0;
  }
  EXPECT_GT(folded, 300);
  EXPECT_LT(folded, 1700);
}

TEST(CameraModel, FisheyeRejectsWhatLiesBeyondTheFold) {
  const CameraModel camera = fisheye({-0.1, 0.0, 0.0, 0.0});  // grows until theta = 1.826
  const auto at = [](double theta) { return Eigen::Vector3d(std::sin(theta), 0.0, std::cos(theta)); };
  EXPECT_TRUE(camera.project(at(1.8)));
  EXPECT_FALSE(camera.project(at(1.85)));
  EXPECT_FALSE(camera.project(at(3.0)));
}

TEST(CameraModel, RejectsPointsThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const CameraModel& camera : sample_cameras()) {
    EXPECT_FALSE(camera.project({nan, 0.0, 1.0}));
    EXPECT_FALSE(camera.project({0.0, 0.0, std::numeric_limits<double>::infinity()}));
  }
}

TEST(CameraModel, ContainsCountsWholePixels) {
  const CameraModel camera = pinhole();
  EXPECT_TRUE(camera.contains({-0.5, -0.5}));
  EXPECT_FALSE(camera.contains({-0.51, 0.0}));
  EXPECT_TRUE(camera.contains({639.49, 511.49}));
  EXPECT_FALSE(camera.contains({639.5, 0.0}));
  EXPECT_FALSE(camera.contains({3.0, 100.0}, 5.0));
  EXPECT_FALSE(camera.contains({std::numeric_limits<double>::quiet_NaN(), 1.0}));
}

TEST(CameraModel, ScaledSeesTheSameRays) {
  const CameraModel camera = pinhole({-0.1, 0.01, 0.0, 0.0});
  const CameraModel half = camera.scaled(0.5);
  EXPECT_EQ(half.width_px, 320);
  EXPECT_THAT(half.unproject({-0.5, -0.5}), IsNear(camera.unproject({-0.5, -0.5}), 1e-12));
  EXPECT_THAT(half.unproject({319.5, 255.5}), IsNear(camera.unproject({639.5, 511.5}), 1e-12));
  EXPECT_GE(camera.scaled(1e-9).width_px, 1);
}

TEST(CameraModel, ValidateNamesWhatIsWrong) {
  EXPECT_TRUE(pinhole().validate());
  CameraModel bad = pinhole();
  bad.width_px = 0;
  EXPECT_FALSE(bad.validate());
  bad = pinhole();
  bad.fy_px = -1.0;
  EXPECT_FALSE(bad.validate());
  bad = pinhole();
  bad.distortion[3] = std::numeric_limits<double>::quiet_NaN();
  ASSERT_FALSE(bad.validate());
  EXPECT_EQ(bad.validate().error().code, Errc::kInvalidConfig);
  EXPECT_FALSE(pinhole_k3({}, std::numeric_limits<double>::infinity()).validate());
}

}  // namespace
}  // namespace edgesplat::geometry
