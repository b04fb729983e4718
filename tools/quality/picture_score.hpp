// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/image.hpp"
#include "tools/quality/lpips.hpp"

#include <optional>
#include <span>

namespace edgesplat::quality {

struct PictureScore {
  double psnr_db = 0.0;
  double ssim = 0.0;
  std::optional<double> lpips;  ///< what does not count is taken as equal; nothing without a network
};

/// `weight` [H,W] 0..1, how much a pixel counts; empty: all of them. `lpips` may be null. kInvalidArgument
/// for sizes that differ.
[[nodiscard]] Result<PictureScore> score_picture(const sensor::ImageRgb8& drawn,
                                                 const sensor::ImageRgb8& real, std::span<const float> weight,
                                                 Lpips* lpips);

/// How much of a picture a weight as above lets count, 0..1.
[[nodiscard]] double share_that_counts(std::span<const float> weight);

}  // namespace edgesplat::quality
