// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/curve.hpp"

#include <cmath>
#include <cstddef>

namespace edgesplat::simulate {

Polyline resample(const Polyline& line, bool closed, double spacing_m) {
  Polyline out;
  const std::size_t segments = closed ? line.size() : line.size() - 1;
  double ahead_m = 0.0;  // from the segment's start to the next point
  for (std::size_t i = 0; i < segments; ++i) {
    const Eigen::Vector3d& a = line[i];
    const Eigen::Vector3d& b = line[(i + 1) % line.size()];
    const double length_m = (b - a).norm();
    for (; ahead_m < length_m; ahead_m += spacing_m) out.push_back(a + (b - a) * (ahead_m / length_m));
    ahead_m -= length_m;
  }
  if (!closed) out.push_back(line.back());
  return out;
}

Polyline smooth_closed(const Polyline& line, double reach_m) {
  constexpr double kSpacing_m = 0.1;
  const Polyline fine = resample(line, true, kSpacing_m);
  const auto reach = static_cast<std::size_t>(std::lround(reach_m / kSpacing_m));
  Polyline out;
  out.reserve(fine.size());
  for (std::size_t i = 0; i < fine.size(); ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k <= 2 * reach; ++k) sum += fine[(i + fine.size() + k - reach) % fine.size()];
    out.push_back(sum / static_cast<double>(2 * reach + 1));
  }
  return out;
}

Polyline offset_left(const Polyline& line, bool closed, double left_m) {
  Polyline out;
  out.reserve(line.size());
  const std::size_t n = line.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d& before = line[i > 0 ? i - 1 : closed ? n - 1 : 0];
    const Eigen::Vector3d& after = line[i + 1 < n ? i + 1 : closed ? 0 : n - 1];
    const Eigen::Vector3d along = (after - before).normalized();
    out.push_back(line[i] + left_m * Eigen::Vector3d(-along.y(), along.x(), 0.0));
  }
  return out;
}

}  // namespace edgesplat::simulate
