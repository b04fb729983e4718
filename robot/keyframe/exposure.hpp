// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/image.hpp"

namespace edgesplat::keyframe {

/// Brings every picture to the exposure of the first one, so that a wall has one colour in the map whatever
/// the camera's automatic did. Values are taken as sRGB, light as proportional to the exposure time (IEC
/// 61966-2-1; gain and aperture fixed). What was clipped stays clipped. Single-owner.
class ExposureEqualiser {
 public:
  /// The picture as if exposed as long as the first one given. `exposure_s` <= 0 or not finite: unknown,
  /// returned as it is.
  [[nodiscard]] sensor::ImageRgb8 equalise(const sensor::ImageRgb8& picture, float exposure_s);
  /// Of the first picture with a known exposure; 0 before it.
  [[nodiscard]] float reference_s() const { return reference_s_; }

 private:
  float reference_s_ = 0.0F;
};

}  // namespace edgesplat::keyframe
