// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/pointcloud/deskew.hpp"

#include "common/base/check.hpp"
#include "common/geometry/so3.hpp"

#include <cstddef>
#include <vector>

namespace edgesplat::pointcloud {
namespace {

/// The motion from one knot to the next, ready to be applied to a point at a fraction of it.
struct Segment {
  std::int32_t first_before_end_ns;
  std::int32_t last_before_end_ns;
  float inverse_span_per_ns;
  Eigen::Matrix3f rotation;       ///< of the first knot
  Eigen::Vector3f translation_m;  ///< of the first knot
  Eigen::Vector3f turn_rad;       ///< right rotation to the next knot
  Eigen::Vector3f step_m;         ///< translation to the next knot

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

Segment segment_between(const MotionKnot& first, const MotionKnot& last) {
  Segment segment;
  segment.first_before_end_ns = first.before_end_ns;
  segment.last_before_end_ns = last.before_end_ns;
  const auto span_ns = static_cast<float>(first.before_end_ns - last.before_end_ns);
  segment.inverse_span_per_ns = span_ns > 0.0F ? 1.0F / span_ns : 0.0F;
  segment.rotation = first.end_from_sensor.rotation.toRotationMatrix().cast<float>();
  segment.translation_m = first.end_from_sensor.translation_m.cast<float>();
  segment.turn_rad =
      geometry::so3_log(first.end_from_sensor.rotation.conjugate() * last.end_from_sensor.rotation)
          .cast<float>();
  segment.step_m = (last.end_from_sensor.translation_m - first.end_from_sensor.translation_m).cast<float>();
  return segment;
}

}  // namespace

void deskew(std::span<const Eigen::Vector3f> points, std::span<const std::int32_t> before_end_ns,
            std::span<const MotionKnot> knots, std::span<Eigen::Vector3f> moved) {
  EDGESPLAT_CHECK(!knots.empty(), "deskewing needs a motion");
  EDGESPLAT_CHECK(points.size() == before_end_ns.size() && points.size() == moved.size(), "one time a point");
  std::vector<Segment> segments;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k)
    segments.push_back(segment_between(knots[k], knots[k + 1]));
  if (segments.empty()) segments.push_back(segment_between(knots[0], knots[0]));
  std::size_t current = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    while (current + 1 < segments.size() && before_end_ns[i] < segments[current].last_before_end_ns)
      ++current;
    while (current > 0 && before_end_ns[i] > segments[current].first_before_end_ns) --current;
    moved[i] = segments[current].apply(points[i], before_end_ns[i]);
  }
}

}  // namespace edgesplat::pointcloud
