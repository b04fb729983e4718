// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/gaussian/sh_rotation.hpp"

#include "kernels/splat/sh_math.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

namespace edgesplat::gaussian {
namespace {

using Coefficients = ShRotation::Coefficients;

std::array<double, 9> row_major(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

ShRotation rotation_of(const Eigen::Quaterniond& q) {
  return ShRotation(row_major(q.toRotationMatrix()));
}

Coefficients random_coefficients(test::Random& random) {
  Coefficients c{};
  for (double& v : c) v = random.uniform(-1.0, 1.0);
  return c;
}

/// What bands 1..degree add to the colour seen in a direction, by the renderer's own basis.
double seen(int degree, const Coefficients& c, const Eigen::Vector3d& direction) {
  std::array<double, 16> basis{};
  splat::sh_basis(degree, direction.x(), direction.y(), direction.z(), basis.data());
  double sum = 0.0;
  for (std::size_t i = 1; i < static_cast<std::size_t>((degree + 1) * (degree + 1)); ++i)
    sum += basis[i] * c[i - 1];
  return sum;
}

TEST(ShRotation, WhatIsTurnedLooksFromTheTurnedDirectionAsBefore) {
  test::Random random(1);
  for (int round = 0; round < 200; ++round) {
    const Eigen::Quaterniond q = random.rotation();
    const ShRotation rotation = rotation_of(q);
    const Coefficients c = random_coefficients(random);
    for (int degree = 1; degree <= 3; ++degree) {
      const Coefficients turned = rotation.turned(degree, c);
      for (int i = 0; i < 10; ++i) {
        const Eigen::Vector3d direction = random.direction();
        ASSERT_NEAR(seen(degree, turned, q * direction), seen(degree, c, direction), 1e-12)
            << "degree " << degree;
      }
    }
  }
}

TEST(ShRotation, BandsAboveTheDegreePassThrough) {
  test::Random random(2);
  const Coefficients c = random_coefficients(random);
  const ShRotation rotation = rotation_of(random.rotation());
  EXPECT_EQ(rotation.turned(0, c), c);
  const Coefficients turned = rotation.turned(2, c);
  for (std::size_t i = 8; i < 15; ++i) EXPECT_EQ(turned[i], c[i]);
}

TEST(ShRotation, NoTurnChangesNothing) {
  test::Random random(3);
  const Coefficients c = random_coefficients(random);
  const Coefficients turned = rotation_of(Eigen::Quaterniond::Identity()).turned(3, c);
  for (std::size_t i = 0; i < c.size(); ++i) EXPECT_NEAR(turned[i], c[i], 1e-15);
}

TEST(ShRotation, KeepsTheLengthOfEachBand) {
  test::Random random(4);
  const Coefficients c = random_coefficients(random);
  const Coefficients turned = rotation_of(random.rotation()).turned(3, c);
  std::size_t first = 0;
  for (std::size_t count = 3; count <= 7; count += 2) {
    double before = 0.0, after = 0.0;
    for (std::size_t i = first; i < first + count; ++i) {
      before += c[i] * c[i];
      after += turned[i] * turned[i];
    }
    EXPECT_NEAR(after, before, 1e-12);
    first += count;
  }
}

}  // namespace
}  // namespace edgesplat::gaussian
