// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/gaussian/sh_rotation.hpp"

#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace edgesplat::gaussian {
namespace {

using Band = std::array<std::array<double, 7>, 7>;

/// One step of the recursion, from band l - 1 to band l, with the symbols of the source. Real harmonics
/// without the INRIA files' signs.
class NextBand {
 public:
  NextBand(const Band& first, const Band& previous, int l) : first_(first), previous_(previous), l_(l) {}

  [[nodiscard]] double element(int m, int n) const {
    const double denominator = std::abs(n) < l_ ? (l_ + n) * (l_ - n) : 2 * l_ * (2 * l_ - 1);
    const int a = std::abs(m);
    double sum = 0.0;
    if (a < l_) sum += std::sqrt((l_ + m) * (l_ - m) / denominator) * p(0, m, n);
    const double v = 0.5 * std::sqrt((l_ + a - 1) * (l_ + a) / denominator);
    sum += m == 0 ? -std::sqrt(2.0) * v * v_part(m, n) : v * v_part(m, n);
    if (m != 0 && a < l_ - 1) sum -= 0.5 * std::sqrt((l_ - a - 1) * (l_ - a) / denominator) * w_part(m, n);
    return sum;
  }

 private:
  [[nodiscard]] double p(int i, int a, int b) const {
    const auto& first = first_[static_cast<std::size_t>(i + 1)];
    const auto& row = previous_[static_cast<std::size_t>(a + l_ - 1)];
    const auto last = static_cast<std::size_t>(2 * l_ - 2);
    if (b == l_) return first[2] * row[last] - first[0] * row[0];
    if (b == -l_) return first[2] * row[0] + first[0] * row[last];
    return first[1] * row[static_cast<std::size_t>(b + l_ - 1)];
  }
  [[nodiscard]] double v_part(int m, int n) const {
    if (m == 0) return p(1, 1, n) + p(-1, -1, n);
    if (m == 1) return std::sqrt(2.0) * p(1, 0, n);
    if (m == -1) return std::sqrt(2.0) * p(-1, 0, n);
    return m > 0 ? p(1, m - 1, n) - p(-1, -m + 1, n) : p(1, m + 1, n) + p(-1, -m - 1, n);
  }
  [[nodiscard]] double w_part(int m, int n) const {
    return m > 0 ? p(1, m + 1, n) + p(-1, -m - 1, n) : p(1, m - 1, n) - p(-1, -m + 1, n);
  }

  const Band& first_;
  const Band& previous_;
  const int l_;
};

/// Band 1 is the rotation matrix in the order y, z, x.
Band first_band(const std::array<double, 9>& r) {
  constexpr std::array<std::size_t, 3> kAxis = {1, 2, 0};
  Band band{};
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t n = 0; n < 3; ++n) band[m][n] = r[3 * kAxis[m] + kAxis[n]];
  }
  return band;
}

/// The INRIA files have odd m negated.
void change_signs(Band& band, int l) {
  for (int m = -l; m <= l; ++m) {
    for (int n = -l; n <= l; ++n) {
      if ((m + n) % 2 != 0) band[static_cast<std::size_t>(m + l)][static_cast<std::size_t>(n + l)] *= -1.0;
    }
  }
}

}  // namespace

ShRotation::ShRotation(const std::array<double, 9>& new_from_old) {
  bands_[0] = first_band(new_from_old);
  for (int l = 2; l <= kMaxDegree; ++l) {
    const NextBand next(bands_[0], bands_[static_cast<std::size_t>(l - 2)], l);
    Band& band = bands_[static_cast<std::size_t>(l - 1)];
    for (int m = -l; m <= l; ++m) {
      for (int n = -l; n <= l; ++n)
        band[static_cast<std::size_t>(m + l)][static_cast<std::size_t>(n + l)] = next.element(m, n);
    }
  }
  for (int l = 1; l <= kMaxDegree; ++l) change_signs(bands_[static_cast<std::size_t>(l - 1)], l);
}

ShRotation::Coefficients ShRotation::turned(int degree, const Coefficients& coefficients) const {
  Coefficients out = coefficients;
  std::size_t first = 0;
  for (std::size_t l = 1; l <= static_cast<std::size_t>(degree); ++l) {
    const std::size_t count = 2 * l + 1;
    for (std::size_t m = 0; m < count; ++m) {
      double sum = 0.0;
      for (std::size_t n = 0; n < count; ++n) sum += bands_[l - 1][m][n] * coefficients[first + n];
      out[first + m] = sum;
    }
    first += count;
  }
  return out;
}

}  // namespace edgesplat::gaussian
