// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/body_spline.hpp"

#include "common/base/check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace edgesplat::simulate {
namespace {

using Row = std::array<double, BodySpline::kOrder>;

// 120 * weight of control point c = sum over p of kBasis[p][c] u^p (uniform quintic B-spline).
constexpr std::array<Row, BodySpline::kOrder> kBasis = {{{1, 26, 66, 26, 1, 0},
                                                         {-5, -50, 0, 50, 5, 0},
                                                         {10, 20, -60, 20, 10, 0},
                                                         {-10, 20, 0, -20, 10, 0},
                                                         {5, -20, 30, -20, 5, 0},
                                                         {-1, 5, -10, 10, -5, 1}}};

Row weights(double u, int order) {
  Row out{};
  double power = 1.0 / 120.0;  // u^(p - order)
  for (int p = order; p < static_cast<int>(BodySpline::kOrder); ++p) {
    double factor = power;
    for (int k = 0; k < order; ++k) factor *= p - k;
    for (std::size_t c = 0; c < out.size(); ++c) out[c] += factor * kBasis[static_cast<std::size_t>(p)][c];
    power *= u;
  }
  return out;
}

}  // namespace

std::size_t BodySpline::control_points_for(double duration_s, double knot_s) {
  return static_cast<std::size_t>(std::ceil(duration_s / knot_s)) + kOrder;
}

BodySpline::BodySpline(std::vector<BodyCoordinates> control_points, double knot_s)
    : control_points_(std::move(control_points)), knot_s_(knot_s) {
  EDGESPLAT_CHECK(control_points_.size() >= kOrder && knot_s_ > 0.0, "a spline needs its order of points");
}

double BodySpline::duration_s() const {
  return static_cast<double>(control_points_.size() - kOrder + 1) * knot_s_;
}

BodyCoordinates BodySpline::derivative(double time_s, int order) const {
  EDGESPLAT_CHECK(order >= 0 && order <= 3, "derivatives of order 0 to 3");
  const double position = std::clamp(time_s, 0.0, duration_s()) / knot_s_;
  const std::size_t segment = std::min(static_cast<std::size_t>(position), control_points_.size() - kOrder);
  const Row w = weights(position - static_cast<double>(segment), order);
  BodyCoordinates sum = BodyCoordinates::Zero();
  for (std::size_t c = 0; c < kOrder; ++c) sum += w[c] * control_points_[segment + c];
  return sum / std::pow(knot_s_, order);
}

}  // namespace edgesplat::simulate
