// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/coloured_map.hpp"

#include "robot/keyframe/cell_key.hpp"

namespace edgesplat::keyframe {

void ColouredMap::add(const map::Keyframe& keyframe) {
  const Eigen::Matrix3f rotation = keyframe.odom_from_body.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = keyframe.odom_from_body.translation_m.cast<float>();
  for (const map::ColouredPoint& p : keyframe.points_in_body) {
    if (!p.has_colour) continue;
    const Eigen::Vector3f p_in_odom_m = rotation * p.p_in_body_m + translation;
    const auto key = cell_key(p_in_odom_m, spacing_m_);
    if (!key || occupied_.contains(*key)) continue;
    if (points_.size() >= max_points_) {
      ++dropped_;
      continue;
    }
    occupied_.insert(*key);
    points_.push_back({p_in_odom_m, p.rgb, true});
  }
}

}  // namespace edgesplat::keyframe
