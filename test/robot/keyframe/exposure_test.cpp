// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/exposure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

namespace edgesplat::keyframe {
namespace {

std::uint8_t srgb8(double light) {
  const double l = std::min(1.0, light);
  return static_cast<std::uint8_t>(
      std::lround(255.0 * (l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1.0 / 2.4) - 0.055)));
}

/// A row of surfaces from dark to bright, as a camera delivers it after `exposure` times 10 ms.
sensor::ImageRgb8 grey_ramp(double exposure) {
  sensor::ImageRgb8 picture(64, 1);
  for (int x = 0; x < 64; ++x) {
    for (int c = 0; c < 3; ++c) picture.pixel(x, 0)[c] = srgb8(exposure * 0.01 * (x + 1));
  }
  return picture;
}

TEST(ExposureEqualiser, UndoesALongerAndAShorterExposure) {
  ExposureEqualiser equaliser;
  const auto reference = grey_ramp(1.0);
  EXPECT_EQ(equaliser.equalise(reference, 0.010F).values, reference.values);
  for (const double factor : {0.7, 1.4}) {
    const auto equal = equaliser.equalise(grey_ramp(factor), static_cast<float>(0.010 * factor));
    for (std::size_t i = 0; i < equal.values.size(); ++i) {
      EXPECT_LE(std::abs(equal.values[i] - reference.values[i]), 2) << factor << " at " << i;
    }
  }
  EXPECT_FLOAT_EQ(equaliser.reference_s(), 0.010F);
}

TEST(ExposureEqualiser, LeavesPicturesOfUnknownExposureAlone) {
  ExposureEqualiser equaliser;
  const auto dark = grey_ramp(0.5);
  EXPECT_EQ(equaliser.equalise(dark, 0.0F).values, dark.values);
  EXPECT_EQ(equaliser.equalise(dark, std::numeric_limits<float>::quiet_NaN()).values, dark.values);
  EXPECT_EQ(equaliser.reference_s(), 0.0F);
  (void)equaliser.equalise(grey_ramp(1.0), 0.010F);
  EXPECT_EQ(equaliser.equalise(dark, 0.0F).values, dark.values);
}

}  // namespace
}  // namespace edgesplat::keyframe
