// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/gaussian_brightness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace edgesplat::tracking {
namespace {

constexpr double kLeastNoise_grey = 2.0;
constexpr double kExplainedShare = 0.5;

double residual(const GaussianPixel& pixel, float seen, const Brightness& brightness) {
  return static_cast<double>(seen) - brightness.gain * static_cast<double>(pixel.value) - brightness.offset;
}

}  // namespace

Brightness guess_brightness(std::span<const GaussianPixel> pixels, std::span<const float> seen) {
  Brightness guess;
  double most_off = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 2; ++round) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (seen[i] < 0.0F || std::abs(residual(pixels[i], seen[i], guess)) > most_off) continue;
      const double map = static_cast<double>(pixels[i].value), value = static_cast<double>(seen[i]);
      n += 1.0, x += map, y += value, xx += map * map, xy += map * value;
    }
    if (n < 2.0) return {};
    const double spread = xx - x * x / n;
    guess.gain = spread > 1.0 ? (xy - x * y / n) / spread : 1.0;
    guess.offset = (y - guess.gain * x) / n;
    double squares = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
      if (seen[i] >= 0.0F) squares += std::pow(residual(pixels[i], seen[i], guess), 2);
    most_off = 1.5 * std::sqrt(squares / n);
  }
  return guess;
}

double residual_noise_grey(std::span<const GaussianPixel> pixels, std::span<const float> seen,
                           const Brightness& brightness) {
  constexpr double kSigmaOfMedian = 1.4826;
  std::vector<double> off;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (seen[i] >= 0.0F) off.push_back(std::abs(residual(pixels[i], seen[i], brightness)));
  if (off.empty()) return kLeastNoise_grey;
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return std::max(kLeastNoise_grey, kSigmaOfMedian * *middle);
}

Foretold how_foretold(std::span<const GaussianPixel> pixels, std::span<const float> seen,
                      const Brightness& brightness) {
  double n = 0.0, sum = 0.0, squares = 0.0, explained = 0.0;
  for (const float value : seen) {
    if (value < 0.0F) continue;
    n += 1.0, sum += static_cast<double>(value),
        squares += static_cast<double>(value) * static_cast<double>(value);
  }
  if (n < 1.0) return {};
  const double spread = std::sqrt(std::max(0.0, squares / n - sum / n * sum / n));
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (seen[i] >= 0.0F && std::abs(residual(pixels[i], seen[i], brightness)) < kExplainedShare * spread)
      explained += 1.0;
  return {spread, explained / n};
}

}  // namespace edgesplat::tracking
