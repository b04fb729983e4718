// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/lane_track.hpp"

#include "tools/simulate/world/curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace edgesplat::simulate {

LaneTrack::LaneTrack(const Lane& lane)
    : points_m_(resample(lane.points_m, lane.closed, 0.1)), speed_mps_(lane.speed_mps) {
  if (lane.closed) points_m_.push_back(points_m_.front());
  length_m_ = spacing_m_ * static_cast<double>(points_m_.size() - 1);
}

LaneTrack::Place LaneTrack::place(double start_m, double time_s) const {
  double s = start_m + speed_mps_ * time_s;
  s -= length_m_ * std::floor(s / length_m_);
  const double x = s / spacing_m_;
  const auto i = std::min(static_cast<std::size_t>(x), points_m_.size() - 2);
  return {i, x - static_cast<double>(i)};
}

Eigen::Vector3d LaneTrack::foot_m(double start_m, double time_s) const {
  const auto [i, fraction] = place(start_m, time_s);
  return points_m_[i] + fraction * (points_m_[i + 1] - points_m_[i]);
}

Stance LaneTrack::at(double start_m, double time_s) const {
  const auto [i, fraction] = place(start_m, time_s);
  Stance stance;
  stance.foot_m = points_m_[i] + fraction * (points_m_[i + 1] - points_m_[i]);
  // The heading comes from points farther apart, so that it turns evenly.
  const std::size_t behind = i >= 3 ? i - 3 : 0, ahead = std::min(i + 4, points_m_.size() - 1);
  const double sign = speed_mps_ < 0.0 ? -1.0 : 1.0;
  stance.forward = sign * (points_m_[ahead] - points_m_[behind]).head<2>().normalized();
  stance.travelled_m = std::abs(speed_mps_ * time_s);
  return stance;
}

}  // namespace edgesplat::simulate
