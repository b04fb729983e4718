// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/patch.hpp"

#include "kernels/image/bilinear.hpp"

#include <cmath>
#include <cstddef>

namespace edgesplat::image {
namespace {

constexpr float kHalf = 0.5F * (kPatchSide - 1);

/// All of [x - reach, x + reach] can be interpolated.
bool fits(float x, float reach, int size) {
  return x - reach >= 0.0F && x + reach < static_cast<float>(size - 1);
}

float value_at(const sensor::ImageGray8& picture, float x, float y) {
  const auto ix = static_cast<int>(x);
  const auto iy = static_cast<int>(y);
  return bilinear(picture, ix, iy, x - static_cast<float>(ix), y - static_cast<float>(iy));
}

}  // namespace

std::optional<BorderedPatch> cut_patch(const sensor::ImageGray8& picture, const Eigen::Vector2f& centre_px) {
  if (!fits(centre_px.x(), kHalf + 1.0F, picture.width_px) ||
      !fits(centre_px.y(), kHalf + 1.0F, picture.height_px)) {
    return std::nullopt;
  }
  BorderedPatch patch;
  std::size_t i = 0;
  for (int row = 0; row < kBorderedSide; ++row) {
    for (int column = 0; column < kBorderedSide; ++column, ++i) {
      const float x = centre_px.x() + static_cast<float>(column) - kHalf - 1.0F;
      const float y = centre_px.y() + static_cast<float>(row) - kHalf - 1.0F;
      // Never negative, and lround is a call. NOLINTNEXTLINE(bugprone-incorrect-roundings)
      patch[i] = static_cast<std::uint8_t>(value_at(picture, x, y) + 0.5F);
    }
  }
  return patch;
}

bool sample_patch(const sensor::ImageGray8& picture, const PatchWarp& warp, PatchValues& values) {
  const float nearest = 1.0F - kHalf * warp.growth.cwiseAbs().sum();
  if (!(nearest > 0.5F)) return false;
  const Eigen::Vector2f reach = kHalf / nearest * warp.step.cwiseAbs().rowwise().sum();
  if (!fits(warp.centre_px.x(), reach.x(), picture.width_px) ||
      !fits(warp.centre_px.y(), reach.y(), picture.height_px)) {
    return false;
  }
  std::size_t i = 0;
  for (int row = 0; row < kPatchSide; ++row) {
    const float dy = static_cast<float>(row) - kHalf;
    for (int column = 0; column < kPatchSide; ++column, ++i) {
      const float dx = static_cast<float>(column) - kHalf;
      const float shrink = 1.0F / (1.0F + warp.growth.x() * dx + warp.growth.y() * dy);
      values[i] =
          value_at(picture, warp.centre_px.x() + shrink * (warp.step(0, 0) * dx + warp.step(0, 1) * dy),
                   warp.centre_px.y() + shrink * (warp.step(1, 0) * dx + warp.step(1, 1) * dy));
    }
  }
  return true;
}

PatchTemplate make_template(const BorderedPatch& patch) {
  PatchTemplate made;
  std::size_t i = 0;
  for (std::size_t row = 1; row <= kPatchSide; ++row) {
    for (std::size_t column = 1; column <= kPatchSide; ++column, ++i) {
      const std::size_t at = row * kBorderedSide + column;
      made.value[i] = static_cast<float>(patch[at]);
      made.dx[i] = 0.5F * (static_cast<float>(patch[at + 1]) - static_cast<float>(patch[at - 1]));
      made.dy[i] = 0.5F * (static_cast<float>(patch[at + kBorderedSide]) -
                           static_cast<float>(patch[at - kBorderedSide]));
    }
  }
  return made;
}

}  // namespace edgesplat::image
