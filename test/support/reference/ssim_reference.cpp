// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "test/support/reference/ssim_reference.hpp"

#include <cmath>
#include <cstddef>

namespace edgesplat::test {
namespace {

constexpr int kRadius = 5;

struct Pictures {
  int width_px, height_px;
  const std::vector<double>& x;
  const std::vector<double>& y;
  const std::vector<double>& weight;

  [[nodiscard]] double at(const std::vector<double>& picture, int px, int py, int channel) const {
    if (px < 0 || py < 0 || px >= width_px || py >= height_px) return 0.0;
    const auto pixel = static_cast<std::size_t>(py * width_px + px);
    return weight[pixel] * picture[3 * pixel + static_cast<std::size_t>(channel)];
  }
};

double similarity(const Pictures& p, int px, int py, int channel) {
  double total = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  for (int dy = -kRadius; dy <= kRadius; ++dy) {
    for (int dx = -kRadius; dx <= kRadius; ++dx) {
      const double w = std::exp(-(dx * dx + dy * dy) / (2.0 * 1.5 * 1.5));
      const double a = p.at(p.x, px + dx, py + dy, channel);
      const double b = p.at(p.y, px + dx, py + dy, channel);
      total += w;
      x += w * a;
      y += w * b;
      xx += w * a * a;
      yy += w * b * b;
      xy += w * a * b;
    }
  }
  x /= total;
  y /= total;
  const double var_x = xx / total - x * x, var_y = yy / total - y * y, covariance = xy / total - x * y;
  constexpr double kC1 = 1e-4, kC2 = 9e-4;
  return (2 * x * y + kC1) * (2 * covariance + kC2) / ((x * x + y * y + kC1) * (var_x + var_y + kC2));
}

}  // namespace

double reference_ssim(int width_px, int height_px, const std::vector<double>& x, const std::vector<double>& y,
                      const std::vector<double>& weight) {
  const Pictures pictures{width_px, height_px, x, y, weight};
  double sum = 0.0, total = 0.0;
  for (int py = 0; py < height_px; ++py) {
    for (int px = 0; px < width_px; ++px) {
      const double w = weight[static_cast<std::size_t>(py * width_px + px)];
      for (int c = 0; c < 3; ++c) sum += w * similarity(pictures, px, py, c);
      total += 3.0 * w;
    }
  }
  return sum / total;
}

}  // namespace edgesplat::test
