// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/pointcloud/deskew.hpp"

#include "common/base/check.hpp"
#include "common/geometry/so3.hpp"
#include "kernels/core/simd.hpp"
#include "kernels/pointcloud/motion_segment.hpp"

#include <cstddef>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pointcloud/deskew.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace edgesplat::pointcloud::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR  // the plain loop does it all

std::size_t move_vectors(const MotionSegment&, const float*, const std::int32_t*, float*, std::size_t) {
  return 0;
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using Lanes = hn::Vec<Floats>;

struct Lanes3 {
  Lanes x, y, z;
};

HWY_INLINE Lanes3 broadcast(const Eigen::Vector3f& v) {
  const Floats d;
  return {hn::Set(d, v.x()), hn::Set(d, v.y()), hn::Set(d, v.z())};
}
HWY_INLINE Lanes3 times(const Lanes3& v, Lanes s) {
  return {hn::Mul(s, v.x), hn::Mul(s, v.y), hn::Mul(s, v.z)};
}
HWY_INLINE Lanes3 sum(const Lanes3& a, const Lanes3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// MotionSegment::apply, operation by operation: no multiply-adds, so that every machine gets the same bits.
std::size_t move_vectors(const MotionSegment& segment, const float* points, const std::int32_t* before_end_ns,
                         float* moved, std::size_t count) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const auto first_ns = hn::Set(Ints(), segment.first_before_end_ns);
  const Lanes per_ns = hn::Set(d, segment.inverse_span_per_ns);
  const Lanes3 turn = broadcast(segment.turn_rad), step = broadcast(segment.step_m),
               translation = broadcast(segment.translation_m);
  const Lanes3 columns[] = {broadcast(segment.rotation.col(0)), broadcast(segment.rotation.col(1)),
                            broadcast(segment.rotation.col(2))};
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto since_ns = hn::Sub(first_ns, hn::LoadU(Ints(), before_end_ns + i));
    const Lanes s =
        hn::Min(hn::Max(hn::Mul(hn::ConvertTo(d, since_ns), per_ns), hn::Zero(d)), hn::Set(d, 1.0F));
    Lanes x, y, z;
    hn::LoadInterleaved3(d, points + 3 * i, x, y, z);
    const Lanes3 p = {x, y, z};
    const Lanes3 v = times(turn, s);
    const Lanes3 first = cross(v, p);
    const Lanes3 second = cross(v, first);
    Lanes3 q = sum(sum(p, first), times(second, hn::Set(d, 0.5F)));
    q = sum(q, times(cross(v, second), hn::Set(d, 1.0F / 6.0F)));
    q = sum(times(columns[0], q.x), sum(times(columns[1], q.y), times(columns[2], q.z)));
    q = sum(sum(q, translation), times(step, s));
    hn::StoreInterleaved3(q.x, q.y, q.z, d, moved + 3 * i);
  }
  return i;
}

#endif

}  // namespace
}  // namespace edgesplat::pointcloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgesplat::pointcloud {
namespace {

HWY_EXPORT(move_vectors);

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float), "points lie one behind another");

void move(const MotionSegment& segment, std::span<const Eigen::Vector3f> points,
          std::span<const std::int32_t> before_end_ns, std::span<Eigen::Vector3f> moved) {
  std::size_t i = points.empty()
                      ? 0
                      : HWY_DYNAMIC_DISPATCH(move_vectors)(segment, points[0].data(), before_end_ns.data(),
                                                           moved[0].data(), points.size());
  for (; i < points.size(); ++i) moved[i] = segment.apply(points[i], before_end_ns[i]);
}

MotionSegment segment_between(const MotionKnot& first, const MotionKnot& last) {
  MotionSegment segment;
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
  std::vector<MotionSegment> segments;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k)
    segments.push_back(segment_between(knots[k], knots[k + 1]));
  if (segments.empty()) segments.push_back(segment_between(knots[0], knots[0]));
  std::size_t current = 0;
  const auto follow = [&](std::int32_t time_ns) {
    while (current + 1 < segments.size() && time_ns < segments[current].last_before_end_ns) ++current;
    while (current > 0 && time_ns > segments[current].first_before_end_ns) --current;
    return current;
  };
  for (std::size_t first = 0; first < points.size();) {
    const std::size_t segment = follow(before_end_ns[first]);
    std::size_t last = first + 1;
    while (last < points.size() && follow(before_end_ns[last]) == segment) ++last;
    const std::size_t count = last - first;
    move(segments[segment], points.subspan(first, count), before_end_ns.subspan(first, count),
         moved.subspan(first, count));
    first = last;
  }
}

}  // namespace edgesplat::pointcloud
#endif
