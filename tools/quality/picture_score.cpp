// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/picture_score.hpp"

#include "common/sensor/image_values.hpp"
#include "kernels/train/image_measures.hpp"

#include <numeric>
#include <vector>

namespace edgesplat::quality {
namespace {

/// LPIPS knows no weights: there the drawn picture takes over the real one.
sensor::ImageRgb8 equal_where_nothing_counts(sensor::ImageRgb8 drawn, const sensor::ImageRgb8& real,
                                             std::span<const float> weight) {
  for (std::size_t i = 0; i < weight.size(); ++i) {
    if (weight[i] > 0.0F) continue;
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) drawn.values[k] = real.values[k];
  }
  return drawn;
}

}  // namespace

Result<PictureScore> score_picture(const sensor::ImageRgb8& drawn, const sensor::ImageRgb8& real,
                                   std::span<const float> weight, Lpips* lpips) {
  std::vector<float> a, b;
  sensor::to_unit_floats(drawn, a);
  sensor::to_unit_floats(real, b);
  const train::ColourPair pair{drawn.width_px, drawn.height_px, a, b, weight};
  if (!pair.consistent() || real.width_px != drawn.width_px) {
    return fail(Errc::kInvalidArgument, "pictures of different sizes cannot be compared");
  }
  PictureScore score{train::psnr_db(pair), train::ssim(pair), std::nullopt};
  if (lpips != nullptr) {
    EDGESPLAT_TRY(score.lpips, lpips->distance(equal_where_nothing_counts(drawn, real, weight), real));
  }
  return score;
}

double share_that_counts(std::span<const float> weight) {
  if (weight.empty()) return 1.0;
  return std::accumulate(weight.begin(), weight.end(), 0.0) / static_cast<double>(weight.size());
}

}  // namespace edgesplat::quality
