// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/camera_offset.hpp"

#include "common/geometry/so3.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace edgesplat::sync {
namespace {

constexpr int kWidth_px = 240, kHeight_px = 180;

/// A robot that walks down a hall: forward, with sway and steps, its head turning.
geometry::RigidTransform body_at(double t) {
  geometry::RigidTransform odom_from_body;
  odom_from_body.translation_m = {0.5 * t, 0.25 * std::sin(1.3 * t), 0.04 * std::sin(8.0 * t)};
  const double yaw = 0.25 * std::sin(0.8 * t) + 0.03 * std::sin(5.0 * t + 0.5);
  const double pitch = 0.04 * std::sin(3.1 * t + 1.0);
  odom_from_body.rotation =
      Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY());
  return odom_from_body;
}

/// The hall: walls left and right, floor, ceiling, each with a smooth random pattern.
struct Hall {
  static double hash(int i, int j, int k) {
    std::uint32_t h = static_cast<std::uint32_t>(i) * 374761393U +
                      static_cast<std::uint32_t>(j) * 668265263U +
                      static_cast<std::uint32_t>(k) * 2246822519U;
    h = (h ^ (h >> 13U)) * 1274126177U;
    return (h ^ (h >> 16U)) % 1000 / 1000.0;
  }
  static double pattern(double u, double v, int wall) {
    double sum = 0.0;
    for (const double cell : {0.3, 0.08}) {
      const double x = u / cell, y = v / cell;
      const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
      const double a = x - i, b = y - j;
      sum += (1 - a) * (1 - b) * hash(i, j, wall) + a * (1 - b) * hash(i + 1, j, wall) +
             (1 - a) * b * hash(i, j + 1, wall) + a * b * hash(i + 1, j + 1, wall);
    }
    return 20.0 + 105.0 * sum;
  }
  /// Distance along the ray to the nearest wall, and the grey there.
  static std::pair<double, double> look(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
    struct Wall {
      int axis;
      double at;
    };
    constexpr std::array<Wall, 5> kWalls{Wall{1, 1.6}, Wall{1, -1.6}, Wall{2, -0.9}, Wall{2, 1.7},
                                         Wall{0, 40.0}};
    double nearest = 1e9;
    int wall = 0;
    for (int w = 0; w < 5; ++w) {
      const auto& [axis, at] = kWalls.at(static_cast<std::size_t>(w));
      const double d = (at - from[axis]) / ray[axis];
      if (d > 0.0 && d < nearest) nearest = d, wall = w;
    }
    const Eigen::Vector3d p = from + nearest * ray;
    const int axis = kWalls.at(static_cast<std::size_t>(wall)).axis;
    return {nearest, pattern(p[(axis + 1) % 3], p[(axis + 2) % 3], wall)};
  }
};

class CameraOffsetTest : public testing::Test {
 protected:
  CameraOffsetTest() {
    mount_.model = {.width_px = kWidth_px,
                    .height_px = kHeight_px,
                    .fx_px = 130,
                    .fy_px = 130,
                    .cx_px = 119.5,
                    .cy_px = 89.5};
    Eigen::Matrix3d body_from_camera;  // camera x = -body y, y = -body z, z = body x
    body_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    mount_.body_from_camera.rotation = Eigen::Quaterniond(body_from_camera);
    mount_.body_from_camera.translation_m = {0.1, 0.0, 0.15};
  }
  [[nodiscard]] sensor::ImageRgb8 picture(double t) const {
    const geometry::RigidTransform odom_from_camera = body_at(t) * mount_.body_from_camera;
    sensor::ImageRgb8 image(kWidth_px, kHeight_px);
    for (int y = 0; y < kHeight_px; ++y)
      for (int x = 0; x < kWidth_px; ++x) {
        const Eigen::Vector3d in_camera((x - 119.5) / 130.0, (y - 89.5) / 130.0, 1.0);
        const double grey =
            Hall::look(odom_from_camera.translation_m, odom_from_camera.rotation * in_camera).second;
        std::fill_n(image.pixel(x, y), 3, static_cast<std::uint8_t>(grey));
      }
    return image;
  }
  [[nodiscard]] static std::vector<Eigen::Vector3f> points(double t) {
    const geometry::RigidTransform odom_from_body = body_at(t);
    std::vector<Eigen::Vector3f> out;
    for (int i = 0; i < 1500; ++i) {
      const double azimuth = 2.4 * (Hall::hash(i, 1, 9) - 0.5), height = 1.6 * (Hall::hash(i, 2, 9) - 0.5);
      const Eigen::Vector3d ray = Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), height).normalized();
      const double range = Hall::look(odom_from_body.translation_m, odom_from_body.rotation * ray).first;
      if (range < 40.0) out.emplace_back((range * ray).cast<float>());
    }
    return out;
  }
  static HostTime host(double seconds) { return host_time_from_ns(50'000'000'000) + from_seconds(seconds); }
  /// Pictures whose stamps are `late_s` after they were taken. The last word on being in sync.
  bool run(CameraOffset& check, double from_s, double to_s, double late_s) const {
    for (int k = static_cast<int>(from_s * 10) + 1; k <= static_cast<int>(to_s * 10); ++k) {
      const double t = k * 0.1;
      check.add(host(t), body_at(t), points(t), picture(t - late_s));
    }
    return check.in_sync();
  }
  sensor::CameraMount mount_;
};

TEST_F(CameraOffsetTest, FindsTheDelayThatWasPutIn) {
  for (const double late_s : {0.0, 0.004, 0.02, -0.012}) {
    CameraOffset check({}, mount_);
    (void)run(check, 0.0, 14.0, late_s);
    const auto estimate = check.estimate();
    ASSERT_TRUE(estimate.has_value()) << late_s;
    EXPECT_NEAR(estimate->delay_s, late_s, 0.001 + 0.1 * std::abs(late_s));
    EXPECT_LT(estimate->sigma_s, 0.001);
  }
}

TEST_F(CameraOffsetTest, OverTheLimitItAlarmsAndUnderItNot) {
  CameraOffset good({}, mount_);
  EXPECT_TRUE(run(good, 0.0, 12.0, 0.003));
  EXPECT_EQ(good.alarms(), 0U);
  CameraOffset bad({}, mount_);
  EXPECT_FALSE(run(bad, 0.0, 12.0, 0.012));
  EXPECT_EQ(bad.alarms(), 1U);
}

TEST_F(CameraOffsetTest, AnOffsetThatBeginsInMidRunIsFoundAndItsEndToo) {
  CameraOffset check({.window_s = 6.0}, mount_);
  EXPECT_TRUE(run(check, 0.0, 10.0, 0.0));
  EXPECT_FALSE(run(check, 10.0, 22.0, 0.02));
  EXPECT_TRUE(run(check, 22.0, 34.0, 0.0));
  EXPECT_EQ(check.alarms(), 1U);
}

TEST_F(CameraOffsetTest, WithoutMotionOrPatternNothingIsClaimed) {
  CameraOffset still({}, mount_);
  for (int k = 1; k < 80; ++k) still.add(host(0.1 * k), body_at(1.0), points(1.0), picture(1.0));
  EXPECT_FALSE(still.estimate().has_value());
  EXPECT_TRUE(still.in_sync());
  CameraOffset blind({}, mount_);
  const sensor::ImageRgb8 grey(kWidth_px, kHeight_px, std::uint8_t{128});
  for (int k = 1; k < 80; ++k) blind.add(host(0.1 * k), body_at(0.1 * k), points(0.1 * k), grey);
  EXPECT_FALSE(blind.estimate().has_value());
}

TEST_F(CameraOffsetTest, GapsAndNonsenseAreBorne) {
  CameraOffset check({}, mount_);
  const auto nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Eigen::Vector3f> nonsense{{nan, nan, nan}, {1e30F, 0, 0}, {0, 0, 0}};
  check.add(host(1.0), body_at(1.0), nonsense, picture(1.0));
  check.add(host(0.5), body_at(0.5), nonsense, picture(0.5));
  check.add(host(900.0), body_at(9.0), {}, picture(9.0));
  check.add(host(900.1), body_at(9.1), nonsense, sensor::ImageRgb8(8, 8));
  EXPECT_TRUE(check.in_sync());
}

}  // namespace
}  // namespace edgesplat::sync
