// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace edgesplat::pointcloud {

/// The motion of a sensor from one moment of a sweep to the next, ready to be applied to points in between.
struct MotionSegment {
  std::int32_t first_before_end_ns;
  std::int32_t last_before_end_ns;
  float inverse_span_per_ns;
  Eigen::Matrix3f rotation;       ///< end_from_sensor at the first moment
  Eigen::Vector3f translation_m;  ///< of it
  Eigen::Vector3f turn_rad;       ///< right rotation to the last moment
  Eigen::Vector3f step_m;         ///< translation to the last moment

  /// Before the first moment and after the last the motion stands still.
  [[nodiscard]] Eigen::Vector3f apply(const Eigen::Vector3f& point, std::int32_t before_end_ns) const {
    float s = static_cast<float>(first_before_end_ns - before_end_ns) * inverse_span_per_ns;
    s = s < 0.0F ? 0.0F : (s > 1.0F ? 1.0F : s);
    // Exp(v) p = p + v x p + v x (v x p) / 2 + v x (v x (v x p)) / 6: the next term is under 5e-6 at 0.1 rad.
    const Eigen::Vector3f v = s * turn_rad;
    const Eigen::Vector3f first = v.cross(point);
    const Eigen::Vector3f second = v.cross(first);
    const Eigen::Vector3f turned = point + first + 0.5F * second + (1.0F / 6.0F) * v.cross(second);
    return rotation * turned + translation_m + s * step_m;
  }
};

}  // namespace edgesplat::pointcloud
