// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/hole_fill.hpp"

#include "kernels/mapping/pixel_points.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace edgesplat::mapping {
namespace {

constexpr int kColumn_px = 4;  ///< LiDAR points are sparse: columns are taken together so far

/// The depth measured last, going down each column: what an upright surface goes on with.
class DepthAbove {
 public:
  explicit DepthAbove(const StoredView& view)
      : view_(view), depth_m_(static_cast<std::size_t>(view.camera().width_px / kColumn_px + 1), 0.0F) {}

  /// Takes the measured pixels of all rows up to this one; rows must not go back.
  void go_down_to(int row) {
    const auto width = static_cast<std::uint32_t>(view_.camera().width_px);
    const std::uint32_t end = (static_cast<std::uint32_t>(row) + 1) * width;
    for (; next_ < view_.depths.size() && view_.depths[next_].pixel < end; ++next_) {
      const SparseDepth& d = view_.depths[next_];
      depth_m_[d.pixel % width / kColumn_px] = d.depth_m;
    }
  }
  [[nodiscard]] float at(int x) const {
    const float d = depth_m_[static_cast<std::size_t>(x / kColumn_px)];
    return d > 0.0F ? d : std::numeric_limits<float>::infinity();
  }

 private:
  const StoredView& view_;
  std::vector<float> depth_m_;
  std::size_t next_ = 0;
};

}  // namespace

std::vector<map::ColouredPoint> fill_holes(const StoredView& view,
                                           const geometry::RigidTransform& map_from_body,
                                           const GroundPlane& ground, std::span<const float> alpha,
                                           const HoleFillOptions& options) {
  const geometry::CameraModel& camera = view.camera();
  const FloorDepth floor(ground, view.map_from_camera);
  if (!(floor.height_m() > 0.0F)) return {};
  std::vector<PixelDepth> filled;
  DepthAbove above(view);
  for (int y = 0; y < camera.height_px; y += options.stride_px) {
    above.go_down_to(y);
    for (int x = 0; x < camera.width_px; x += options.stride_px) {
      const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width_px) +
                         static_cast<std::size_t>(x);
      if (alpha[pixel] > options.max_alpha || view.undistorter->seen()[pixel] == 0.0F) continue;
      if (!view.ignored.empty() && view.ignored[pixel]) continue;
      if (!view.unmapped.empty() && view.unmapped[pixel]) continue;
      const float inverse_depth = floor.inverse_depth(ray_of(camera, x, y));
      if (!(inverse_depth > 0.0F)) continue;
      const float depth_m = std::min(1.0F / inverse_depth, above.at(x));
      if (depth_m <= options.max_depth_m) filled.push_back({x, y, depth_m});
    }
  }
  return points_of(filled, view, map_from_body);
}

}  // namespace edgesplat::mapping
