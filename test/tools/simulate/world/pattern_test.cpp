// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/pattern.hpp"

#include "test/tools/simulate/world/random_rays.hpp"
#include "tools/simulate/world/glyphs.hpp"
#include "tools/simulate/world/texture_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::simulate {
namespace {

class EveryPattern : public testing::TestWithParam<int> {
 protected:
  EveryPattern() {
    material_.pattern = static_cast<Pattern>(GetParam());
    material_.base = {0.5F, 0.4F, 0.3F};
    material_.accent = {0.2F, 0.2F, 0.25F};
    material_.period_m = 0.6F;
    material_.contrast = 0.2F;
    material_.seed = 42;
  }
  /// Root mean square difference of neighbours `step_m` apart, seen with a pixel of `footprint_m`.
  double roughness(double step_m, double footprint_m) const {
    double sum = 0.0;
    constexpr int kCount = 2000;
    for (int i = 0; i < kCount; ++i) {
      const Eigen::Vector2d at(0.013 * i, 0.3 + 0.0031 * i);
      const Rgb a = albedo(material_, {at, footprint_m});
      const Rgb b = albedo(material_, {at + Eigen::Vector2d(step_m, 0.0), footprint_m});
      sum += static_cast<double>((a - b).squaredNorm());
    }
    return std::sqrt(sum / kCount);
  }
  Material material_;
};

TEST_P(EveryPattern, StaysWithinWhatPaintReflects) {
  RandomRays rays(7);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector2d at(rays.uniform(0, 30), rays.uniform(0, 4));
    const Rgb colour = albedo(material_, {at, rays.uniform(0.0, 0.05)});
    EXPECT_TRUE((colour.array() > 0.0F).all() && (colour.array() < 1.0F).all()) << colour.transpose();
  }
}

TEST_P(EveryPattern, IsSmoothWithinAPixel) {
  // A band-limited texture changes little over a hundredth of the footprint, at every distance.
  for (const double footprint_m : {0.002, 0.01, 0.05, 0.25})
    EXPECT_LT(roughness(0.01 * footprint_m, footprint_m), 0.012);
}

TEST_P(EveryPattern, FadesToAnEvenColourFarAway) {
  EXPECT_LT(roughness(3.0, 30.0), 0.08);
}

INSTANTIATE_TEST_SUITE_P(Patterns, EveryPattern,
                         testing::Range(0, static_cast<int>(Pattern::kRoadMarks) + 1));

TEST(Pattern, AverageOfASharpViewIsTheBlurredView) {
  // Tiles and bricks are filtered analytically: the mean over a square agrees with one wide look-up.
  Material m;
  m.pattern = Pattern::kTiles;
  m.base = {0.6F, 0.6F, 0.6F};
  m.accent = {0.1F, 0.1F, 0.1F};
  m.period_m = 0.1F;
  m.contrast = 0.0F;
  constexpr double kWide_m = 0.07;
  Rgb sum = Rgb::Zero();
  constexpr int kSide = 100;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j)
      sum += albedo(
          m, {Eigen::Vector2d(1.0 + (i + 0.5) / kSide * kWide_m, 2.0 + (j + 0.5) / kSide * kWide_m), 1e-4});
  const Rgb wide = albedo(m, {Eigen::Vector2d(1.0 + kWide_m / 2, 2.0 + kWide_m / 2), kWide_m});
  EXPECT_NEAR(sum.x() / (kSide * kSide), wide.x(), 0.01);
}

TEST(TextureNoise, IsTheSameOnEveryMachine) {
  EXPECT_EQ(cell_hash(0, 0, 0), 0U);
  EXPECT_EQ(cell_hash(3, -7, 11), cell_hash(3, -7, 11));
  EXPECT_NE(cell_hash(3, -7, 11), cell_hash(-7, 3, 11));
  EXPECT_NE(cell_hash(3, -7, 11), cell_hash(3, -7, 12));
}

TEST(TextureNoise, DropsOctavesBelowTheFootprint) {
  const Octaves octaves{1.0, 0.004, 0.7F, 5};
  double fine = 0.0, coarse = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d at(0.0137 * i, 0.4), next = at + Eigen::Vector2d(0.004, 0.0);
    fine +=
        std::abs(static_cast<double>(octave_noise(at, octaves, 0.001) - octave_noise(next, octaves, 0.001)));
    coarse +=
        std::abs(static_cast<double>(octave_noise(at, octaves, 0.2) - octave_noise(next, octaves, 0.2)));
  }
  EXPECT_GT(fine, 10.0 * coarse);
  EXPECT_EQ(octave_noise({0.3, 0.4}, octaves, 1.0), 0.0F);
}

TEST(Glyphs, InkIsWhereTheLetterIs) {
  EXPECT_FLOAT_EQ(text_coverage("I", 2.5, 3.5, 0.1), 1.0F);  // the stem
  EXPECT_FLOAT_EQ(text_coverage("I", 0.5, 3.5, 0.1), 0.0F);
  EXPECT_FLOAT_EQ(text_coverage("I", 2.5, 9.0, 0.1), 0.0F);
  EXPECT_FLOAT_EQ(text_coverage("?", 2.5, 3.5, 0.1), 0.0F);
  EXPECT_NEAR(text_coverage("HELLO", 15.0, 3.5, 6.0), 0.36F, 0.05F);  // unreadable: grey
}

}  // namespace
}  // namespace edgesplat::simulate
