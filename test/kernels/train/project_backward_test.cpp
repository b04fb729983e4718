// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/train/project_backward_math.hpp"

#include "kernels/train/covariance_backward_math.hpp"
#include "kernels/train/sh_backward_math.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

namespace edgesplat::train {
namespace {

constexpr double kStep = 1e-6;
constexpr double kLowPass = 0.3;

double central(double& parameter, const std::function<double()>& value) {
  const double before = parameter;
  parameter = before + kStep;
  const double above = value();
  parameter = before - kStep;
  const double below = value();
  parameter = before;
  return (above - below) / (2.0 * kStep);
}

struct Case {
  splat::CameraT<double> camera{300.0, 310.0, 160.0, 120.0, 160.0 / 300.0, 120.0 / 310.0, {}, {}};
  std::array<double, 3> mean{}, log_scale{};
  std::array<double, 4> quat{};
  SplatGradient<double> by{};

  explicit Case(std::uint64_t seed, double sideways = 0.0, bool fisheye = false, bool antialiased = false) {
    camera.fisheye = fisheye;
    camera.antialias = antialiased ? 1.0 : 0.0;
    test::Random random(seed);
    const auto pose = random.transform(1.0);
    const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
    const Eigen::Vector3d at =
        pose.inverse() * Eigen::Vector3d(random.uniform(-0.5, 0.5) + sideways, random.uniform(-0.5, 0.5),
                                         random.uniform(1.5, 3.0));
    for (int i = 0; i < 9; ++i) camera.rotation[i] = rotation(i / 3, i % 3);
    for (int i = 0; i < 3; ++i) {
      camera.translation[i] = pose.translation_m[i];
      mean[static_cast<std::size_t>(i)] = at[i];
    }
    for (double& s : log_scale) s = random.uniform(-3.0, -1.0);
    for (double& q : quat) q = random.uniform(-1.0, 1.0);
    by = {random.normal(),
          random.normal(),
          {random.normal(), random.normal(), random.normal()},
          0.0,
          {},
          random.normal(),
          antialiased ? random.normal() : 0.0};
  }
  [[nodiscard]] splat::Projection<double> projected() const {
    double cov3d[6];
    splat::covariance3d(quat.data(), log_scale.data(), cov3d);
    splat::Projection<double> p{};
    EXPECT_TRUE(splat::project_any(camera, mean.data(), cov3d, 0.05, kLowPass, p));
    return p;
  }
  /// What `by` is the gradient of; the conic's share is enlarged, being a small number.
  [[nodiscard]] double loss() const {
    const auto p = projected();
    return by.u * p.u + by.v * p.v + by.conic[0] * p.conic[0] + by.conic[1] * p.conic[1] +
           by.conic[2] * p.conic[2] + by.depth * p.depth + by.log_opacity * std::log(p.shrink);
  }
};

struct Place {
  std::uint64_t seed;
  double sideways;
  bool fisheye, antialiased;
};
class Projecting : public testing::TestWithParam<Place> {
 protected:
  [[nodiscard]] static Case at() {
    const Place& p = GetParam();
    return Case(p.seed, p.sideways, p.fisheye, p.antialiased);
  }
};

TEST_P(Projecting, ReverseAgreesWithDifferences) {
  Case c = at();
  for (double& conic : c.by.conic) conic *= 1e4;
  double cov3d[6];
  splat::covariance3d(c.quat.data(), c.log_scale.data(), cov3d);
  ProjectBackward<double> out{};
  project_backward_any(c.camera, c.mean.data(), cov3d, c.projected().conic, c.by, kLowPass, out);
  std::array<double, 4> by_quat{};
  std::array<double, 3> by_scale{};
  const std::array<double, 3> scale{std::exp(c.log_scale[0]), std::exp(c.log_scale[1]),
                                    std::exp(c.log_scale[2])};
  covariance3d_backward(c.quat.data(), scale.data(), out.cov3d, by_quat.data(), by_scale.data());
  const auto loss = [&c] { return c.loss(); };
  const auto expect = [](double computed, double expected) {
    EXPECT_NEAR(computed, expected, 1e-5 * std::abs(expected) + 1e-3);
  };
  for (std::size_t i = 0; i < 3; ++i) expect(out.mean[i], central(c.mean[i], loss));
  for (std::size_t i = 0; i < 3; ++i) expect(by_scale[i], central(c.log_scale[i], loss));
  for (std::size_t i = 0; i < 4; ++i) expect(by_quat[i], central(c.quat[i], loss));
  for (std::size_t i = 0; i < 3; ++i) expect(out.pose[3 + i], central(c.camera.translation[i], loss));
}

TEST_P(Projecting, TurningTheCameraAgreesWithDifferences) {
  Case c = at();
  double cov3d[6];
  splat::covariance3d(c.quat.data(), c.log_scale.data(), cov3d);
  ProjectBackward<double> out{};
  project_backward_any(c.camera, c.mean.data(), cov3d, c.projected().conic, c.by, kLowPass, out);
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rotation(c.camera.rotation);
  for (int axis = 0; axis < 3; ++axis) {
    double angle = 0.0;
    const double expected = central(angle, [&] {
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> turned =
          rotation * geometry::so3_exp(angle * Eigen::Vector3d::Unit(axis)).toRotationMatrix();
      Case moved = c;
      std::copy_n(turned.data(), 9, moved.camera.rotation);
      return moved.loss();
    });
    EXPECT_NEAR(out.pose[axis], expected, 1e-5 * std::abs(expected) + 1e-4);
  }
}

// Pinholes 4 and 5 lie so far aside that the direction of the Jacobian is clamped.
INSTANTIATE_TEST_SUITE_P(Places, Projecting,
                         testing::Values(Place{1, 0.0, false, false}, Place{2, 0.0, false, false},
                                         Place{3, 0.0, false, true}, Place{4, 3.0, false, false},
                                         Place{5, -4.0, false, true}, Place{6, 0.0, true, false},
                                         Place{7, 2.5, true, false}, Place{8, -6.0, true, true}));

/// Where the series takes over from the closed form.
TEST(Fisheye, SeriesAndClosedFormMeet) {
  for (const double side : {1e-9, 1e-3, 0.1731, 0.1733, 0.4}) {
    const double p[3] = {side, 0.0, 1.0};
    const auto f = splat::fisheye_at(p);
    const double theta = std::atan2(side, 1.0);
    EXPECT_NEAR(f.s, theta / side, 1e-9) << side;
    const float single[3] = {static_cast<float>(side), 0.0F, 1.0F};
    EXPECT_NEAR(splat::fisheye_at(single).g, f.g, 2e-5) << side;
    EXPECT_NEAR(splat::fisheye_at(single).h, f.h, 2e-3) << side;
  }
}

TEST(Colouring, ReverseAgreesWithDifferencesForEveryDegree) {
  test::Random random(6);
  for (int degree = 0; degree <= 3; ++degree) {
    const auto terms = static_cast<std::size_t>((degree + 1) * (degree + 1));
    std::array<double, 3> offset{1.2, -0.7, 2.1}, by_rgb{0.3, -1.1, 0.8}, rgb{1.0, 1.0, 1.0}, by_offset{};
    std::array<double, 48> sh{}, by_sh{};
    for (double& value : sh) value = random.normal();
    const auto loss = [&] {
      const double length = std::hypot(offset[0], offset[1], offset[2]);
      double basis[16], sum = 0.0;
      splat::sh_basis(degree, offset[0] / length, offset[1] / length, offset[2] / length, basis);
      for (std::size_t k = 0; k < terms; ++k)
        for (std::size_t c = 0; c < 3; ++c) sum += by_rgb[c] * basis[k] * sh[3 * k + c];
      return sum;
    };
    colour_backward(degree, offset.data(), sh.data(), rgb.data(), by_rgb.data(), by_sh.data(),
                    by_offset.data());
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(by_offset[i], central(offset[i], loss), 1e-8) << degree;
    for (std::size_t i = 0; i < 3 * terms; ++i) EXPECT_NEAR(by_sh[i], central(sh[i], loss), 1e-8) << degree;
  }
}

TEST(Colouring, AChannelCutAtZeroHasNoGradient) {
  const std::array<double, 3> offset{1.0, 2.0, 3.0}, sh{1.0, -9.0, 1.0}, rgb{0.8, 0.0, 0.8},
      by_rgb{1.0, 1.0, 1.0};
  std::array<double, 3> by_sh{}, by_offset{};
  colour_backward(0, offset.data(), sh.data(), rgb.data(), by_rgb.data(), by_sh.data(), by_offset.data());
  EXPECT_GT(by_sh[0], 0.0);
  EXPECT_EQ(by_sh[1], 0.0);
}

}  // namespace
}  // namespace edgesplat::train
