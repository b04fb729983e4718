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

Stance LaneTrack::at(double start_m, double time_s) const {
  const double travelled_m = speed_mps_ * time_s;
  double s = std::fmod(start_m + travelled_m, length_m_);
  if (s < 0.0) s += length_m_;
  const double x = s / spacing_m_;
  const auto i = std::min(static_cast<std::size_t>(x), points_m_.size() - 2);
  const Eigen::Vector3d step = points_m_[i + 1] - points_m_[i];
  Stance stance;
  stance.foot_m = points_m_[i] + (x - static_cast<double>(i)) * step;
  // The heading comes from points farther apart, so that it turns evenly.
  const std::size_t behind = i >= 3 ? i - 3 : 0, ahead = std::min(i + 4, points_m_.size() - 1);
  stance.forward =
      (points_m_[ahead] - points_m_[behind]).head<2>().normalized() * (speed_mps_ < 0.0 ? -1.0 : 1.0);
  stance.travelled_m = std::abs(travelled_m);
  return stance;
}

}  // namespace edgesplat::simulate
