// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/image.hpp"

#include <Eigen/Core>

#include <optional>

namespace edgesplat::sync {

/// A picture in grey at a third of a thousand pixels across or less, for comparing with others.
struct SmallPicture {
  sensor::ImageF32 grey;
  double scale = 1.0;  ///< small pixels per pixel of the picture
};
[[nodiscard]] SmallPicture shrink(const sensor::ImageRgb8& picture);

/// Side of the square that is compared; a place nearer than half of it to the border has none.
inline constexpr int kPatch_px = 20;

/// Where in `now` that is seen which `before` shows at `at_px`, to some hundredths of a pixel, looked for
/// around `expected_px`; both in small pixels. Lucas and Kanade's method on patches of the same mean and
/// contrast. Nothing where the two do not look alike, or too near to the border.
[[nodiscard]] std::optional<Eigen::Vector2d> find_patch(const SmallPicture& before,
                                                        const Eigen::Vector2d& at_px, const SmallPicture& now,
                                                        const Eigen::Vector2d& expected_px);

}  // namespace edgesplat::sync
