// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/gaussian_pixels.hpp"

#include <span>

namespace edgesplat::tracking {

/// How a picture shows the map's brightness: seen = gain * map + offset, in grey levels.
struct Brightness {
  double gain = 1.0;
  double offset = 0.0;
};

// `seen`: the picture's values where the pixels are, one each; below 0 out of the picture.

/// By least squares, then once more without what is far off; gain 1 where the pixels are of one grey.
[[nodiscard]] Brightness guess_brightness(std::span<const GaussianPixel> pixels, std::span<const float> seen);
/// One sigma of a residual, from the median; at least 2 grey levels.
[[nodiscard]] double residual_noise_grey(std::span<const GaussianPixel> pixels, std::span<const float> seen,
                                         const Brightness& brightness);

/// How well a map foretells a picture.
struct Foretold {
  double spread_grey = 0.0;  ///< one sigma of the picture's own values
  double explained = 0.0;    ///< share of the pixels that the map misses by less than half of that
};
[[nodiscard]] Foretold how_foretold(std::span<const GaussianPixel> pixels, std::span<const float> seen,
                                    const Brightness& brightness);

}  // namespace edgesplat::tracking
