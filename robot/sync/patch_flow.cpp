// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/sync/patch_flow.hpp"

#include <Eigen/LU>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace edgesplat::sync {
namespace {

constexpr int kSmallWidth_px = 320;
constexpr double kMostMoved_px = 6.0;   // from the expected place: further is another pattern
constexpr double kLeastContrast = 3.0;  // deviation of grey values
constexpr double kMostUnlike = 0.5;     // what is left of the contrast when the patches lie on each other
constexpr int kSteps = 12;
constexpr double kConverged_px = 0.01;
constexpr double kPixels = static_cast<double>(kPatch_px) * kPatch_px;

using Patch = Eigen::Matrix<double, kPatch_px, kPatch_px>;

/// Bilinear samples around `centre_px`; nothing over the border.
std::optional<Patch> sample(const sensor::ImageF32& grey, const Eigen::Vector2d& centre_px) {
  const Eigen::Vector2d corner = centre_px.array() - kPatch_px / 2;
  const int x = static_cast<int>(std::floor(corner.x())), y = static_cast<int>(std::floor(corner.y()));
  if (x < 0 || y < 0 || x + kPatch_px + 1 > grey.width_px || y + kPatch_px + 1 > grey.height_px)
    return std::nullopt;
  const double a = corner.x() - x, b = corner.y() - y;
  Patch out;
  for (int j = 0; j < kPatch_px; ++j) {
    const float* above = grey.pixel(x, y + j);
    // The last row and column have weight 0 where the corner is whole.
    const float* below = b > 0.0 ? grey.pixel(x, y + j + 1) : above;
    for (int i = 0; i < kPatch_px; ++i) {
      const int next = a > 0.0 ? i + 1 : i;
      const double top = (1 - a) * static_cast<double>(above[i]) + a * static_cast<double>(above[next]);
      const double bottom = (1 - a) * static_cast<double>(below[i]) + a * static_cast<double>(below[next]);
      out(j, i) = (1 - b) * top + b * bottom;
    }
  }
  return out;
}

/// Mean 0, deviation 1: the exposure may have changed. False for a blank patch.
bool normalise(Patch& patch) {
  patch.array() -= patch.mean();
  const double deviation = std::sqrt(patch.squaredNorm() / kPixels);
  if (deviation < kLeastContrast) return false;
  patch /= deviation;
  return true;
}

}  // namespace

SmallPicture shrink(const sensor::ImageRgb8& picture) {
  SmallPicture out;
  out.scale = std::min(1.0, static_cast<double>(kSmallWidth_px) / picture.width_px);
  const int width_px = static_cast<int>(std::lround(out.scale * picture.width_px));
  const int height_px = std::max(1, static_cast<int>(std::lround(out.scale * picture.height_px)));
  out.grey = sensor::ImageF32(width_px, height_px);
  auto* values =
      const_cast<std::uint8_t*>(picture.values.data());  // NOLINT(cppcoreguidelines-pro-type-const-cast)
  const cv::Mat colour(picture.height_px, picture.width_px, CV_8UC3, values);
  cv::Mat small, grey;
  cv::resize(colour, small, {width_px, height_px}, 0, 0, cv::INTER_AREA);
  cv::cvtColor(small, grey, cv::COLOR_RGB2GRAY);
  cv::Mat as_float(height_px, width_px, CV_32F, out.grey.values.data());
  grey.convertTo(as_float, CV_32F);
  return out;
}

std::optional<Eigen::Vector2d> find_patch(const SmallPicture& before, const Eigen::Vector2d& at_px,
                                          const SmallPicture& now, const Eigen::Vector2d& expected_px) {
  if (!at_px.allFinite() || !expected_px.allFinite()) return std::nullopt;
  if (at_px.cwiseAbs().maxCoeff() > 1e6 || expected_px.cwiseAbs().maxCoeff() > 1e6) return std::nullopt;
  auto wanted = sample(before.grey, at_px);
  if (!wanted || !normalise(*wanted)) return std::nullopt;
  Eigen::Vector2d place = expected_px;
  for (int step = 0; step < kSteps; ++step) {
    auto seen = sample(now.grey, place);
    const auto right = sample(now.grey, place + Eigen::Vector2d(0.5, 0)),
               left = sample(now.grey, place - Eigen::Vector2d(0.5, 0));
    const auto below = sample(now.grey, place + Eigen::Vector2d(0, 0.5)),
               above = sample(now.grey, place - Eigen::Vector2d(0, 0.5));
    if (!seen || !right || !left || !below || !above) return std::nullopt;
    const double contrast = std::sqrt((seen->array() - seen->mean()).square().sum() / kPixels);
    if (!normalise(*seen)) return std::nullopt;
    const Patch gx = (*right - *left) / contrast, gy = (*below - *above) / contrast;
    const Patch off = *seen - *wanted;
    Eigen::Matrix2d normal;
    normal << gx.squaredNorm(), gx.cwiseProduct(gy).sum(), gx.cwiseProduct(gy).sum(), gy.squaredNorm();
    if (normal.determinant() < 1e-6 * normal.trace() * normal.trace()) return std::nullopt;  // an edge alone
    const Eigen::Vector2d move =
        -normal.inverse() * Eigen::Vector2d(gx.cwiseProduct(off).sum(), gy.cwiseProduct(off).sum());
    place += move;
    if (!((place - expected_px).norm() <= kMostMoved_px)) return std::nullopt;
    if (move.norm() > kConverged_px) continue;
    if (off.squaredNorm() / kPixels > kMostUnlike) return std::nullopt;
    return place;
  }
  return std::nullopt;
}

}  // namespace edgesplat::sync
