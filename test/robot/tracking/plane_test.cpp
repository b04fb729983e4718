// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/plane.hpp"

#include "common/sensor/rig.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <vector>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;

struct Patch {
  Eigen::Matrix3d axes;           ///< normal, and two directions in the plane
  std::vector<Vector3d> truth_m;  ///< on the plane
};

Patch make_patch(int points, double half_width_m, std::uint64_t seed) {
  test::Random random(seed);
  Patch patch;
  patch.axes = random.rotation().toRotationMatrix();
  for (int i = 0; i < points; ++i) {
    patch.truth_m.push_back(0.1 * patch.axes.col(0) +
                            random.uniform(-half_width_m, half_width_m) * patch.axes.col(1) +
                            random.uniform(-half_width_m, half_width_m) * patch.axes.col(2));
  }
  return patch;
}

PointSums noisy_sums(const Patch& patch, const Eigen::Matrix3d& covariance, test::Random& random) {
  const Eigen::Matrix3d root = covariance.llt().matrixL();
  PointSums sums;
  for (const Vector3d& p : patch.truth_m) {
    const Vector3d noise = root * Vector3d(random.normal(), random.normal(), random.normal());
    sums.add((p + noise).cast<float>(), pack(covariance.cast<float>()), Symmetric3f::Zero());
  }
  return sums;
}

TEST(PointNoise, AgreesAlongADirectionWithTheWholeMatrix) {
  const PointNoise noise(sensor::LidarModel{});
  const Eigen::Vector3f ray(8.0F, -3.0F, 1.0F);
  const Eigen::Vector3f direction = Eigen::Vector3f(0.2F, 0.9F, -0.4F).normalized();
  EXPECT_NEAR(noise.variance_along(ray, direction), direction.dot(noise.covariance(ray) * direction), 1e-8F);
  EXPECT_NEAR(std::sqrt(noise.variance_along(ray, ray.normalized())), 0.02F, 1e-6F);
}

TEST(PlaneFit, FindsTheNormalOfExactPoints) {
  const Patch patch = make_patch(20, 0.4, 1);
  PointSums sums;
  for (const Vector3d& p : patch.truth_m) sums.add(p.cast<float>(), Symmetric3f::Zero(), Symmetric3f::Zero());
  const PlaneFit fit = fit_plane(sums, 0.05F);
  ASSERT_EQ(fit.verdict, PlaneVerdict::kPlane);
  EXPECT_NEAR(std::abs(fit.plane.normal.cast<double>().dot(patch.axes.col(0))), 1.0, 1e-5);
  EXPECT_NEAR(
      fit.plane.normal.cast<double>().dot(patch.axes.col(0)) * fit.plane.normal.dot(fit.plane.centre_m), 0.1,
      1e-4);
}

TEST(PlaneFit, TellsLinesAndClumpsFromPlanes) {
  PointSums line, clump;
  test::Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Vector3d jitter = 0.005 * Vector3d(random.normal(), random.normal(), random.normal());
    line.add((Vector3d(0.02 * i, 0, 0) + jitter).cast<float>(), Symmetric3f::Zero(), Symmetric3f::Zero());
    clump.add(random.vector(0.4).cast<float>(), Symmetric3f::Zero(), Symmetric3f::Zero());
  }
  EXPECT_EQ(fit_plane(line, 0.05F).verdict, PlaneVerdict::kUndecided);
  EXPECT_EQ(fit_plane(clump, 0.05F).verdict, PlaneVerdict::kNoPlane);
  EXPECT_EQ(fit_plane(PointSums{}, 0.05F).verdict, PlaneVerdict::kNoPlane);
}

/// The stated variance of the plane's height below several places, against the spread over many noisy fits.
void expect_honest_variance(const Eigen::Matrix3d& covariance, double tolerance) {
  const Patch patch = make_patch(30, 0.4, 7);
  const Vector3d normal = patch.axes.col(0);
  const std::vector<Vector3d> places = {0.1 * normal, 0.1 * normal + 0.4 * patch.axes.col(1),
                                        0.1 * normal - 0.3 * patch.axes.col(1) + 0.3 * patch.axes.col(2)};
  std::vector<double> squares(places.size(), 0.0), stated(places.size(), 0.0);
  test::Random random(11);
  constexpr int kRuns = 3000;
  for (int run = 0; run < kRuns; ++run) {
    const PlaneFit fit = fit_plane(noisy_sums(patch, covariance, random), 0.1F);
    ASSERT_EQ(fit.verdict, PlaneVerdict::kPlane);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Eigen::Vector3f d = places[i].cast<float>() - fit.plane.centre_m;
      squares[i] += std::pow(static_cast<double>(fit.plane.normal.dot(d)), 2) / kRuns;
      stated[i] += static_cast<double>(fit.plane.variance_at(d) - fit.plane.excess_variance_m2) / kRuns;
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_NEAR(stated[i] / squares[i], 1.0, tolerance) << "place " << i;
}

TEST(PlaneFit, CovarianceAgreesWithMonteCarloForEvenNoise) {
  // The roughness term takes part of the sample's scatter for noise again: up to a fifth on the cautious
  // side.
  expect_honest_variance(1e-4 * Eigen::Matrix3d::Identity(), 0.25);
}

TEST(PlaneFit, CovarianceAgreesWithMonteCarloForARay) {
  const PointNoise noise(sensor::LidarModel{});
  expect_honest_variance(noise.covariance(Eigen::Vector3f(9.0F, 2.0F, 1.0F)).cast<double>(), 0.25);
}

TEST(PlaneFit, RoughGroundIsNotTakenForAnExactPlane) {
  const Patch patch = make_patch(60, 0.4, 5);
  test::Random random(6);
  PointSums sums;
  for (const Vector3d& p : patch.truth_m) {
    sums.add((p + 0.03 * random.normal() * patch.axes.col(0)).cast<float>(),
             pack((1e-6 * Eigen::Matrix3d::Identity()).cast<float>()), Symmetric3f::Zero());
  }
  const PlaneFit fit = fit_plane(sums, 0.1F);
  ASSERT_EQ(fit.verdict, PlaneVerdict::kPlane);
  EXPECT_NEAR(std::sqrt(fit.plane.excess_variance_m2), 0.03F, 0.008F);
}

}  // namespace
}  // namespace edgesplat::tracking
