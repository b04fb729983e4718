// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/pixel_projector.hpp"
#include "kernels/mapping/stored_view.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace edgesplat::mapping {

/// When a measurement proves that a place is empty: source free-space carving, as in occupancy grids
/// (Moravec 1985), with the depths of one keyframe.
struct LookThrough {
  float margin_m = 0.25F;          ///< the LiDAR must measure so far behind the place, 0.05..5 ...
  float margin_per_range = 0.03F;  ///< ... plus this share of its distance, 0..0.5
  int reach_px = 4;                ///< measurements so far from it in the picture count, 0..16
  int least_rays = 4;              ///< so many of them must pass it and none may stop at it, 1..64
};

/// The depths of a view as a picture to look around in. Immutable.
class DepthPicture {
 public:
  explicit DepthPicture(const StoredView& view)
      : projector_(view.map_from_camera.inverse(), view.camera()),
        width_(view.camera().width_px),
        height_(view.camera().height_px),
        depth_m_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0F) {
    for (const SparseDepth& d : view.depths) depth_m_[d.pixel] = d.depth_m;
  }

  /// The view's rays went through this place: at its moment nothing was there.
  [[nodiscard]] bool looks_through(const Eigen::Vector3f& p_in_map_m, const LookThrough& by) const {
    constexpr float kNearest_m = 0.2F;
    const auto hit = projector_.project(p_in_map_m, kNearest_m);
    if (!hit) return false;
    const float beyond_m = hit->depth_m + by.margin_m + by.margin_per_range * hit->depth_m;
    return rays_beyond(hit->x, hit->y, by.reach_px, beyond_m) >= by.least_rays;
  }

 private:
  /// How many rays near (x, y) passed `beyond_m`; none where one stopped before it.
  [[nodiscard]] int rays_beyond(int x, int y, int reach, float beyond_m) const {
    int count = 0;
    for (int v = std::max(0, y - reach); v <= std::min(height_ - 1, y + reach); ++v) {
      for (int u = std::max(0, x - reach); u <= std::min(width_ - 1, x + reach); ++u) {
        const float d = depth_m_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
                                 static_cast<std::size_t>(u)];
        if (d == 0.0F) continue;
        if (d < beyond_m) return 0;
        ++count;
      }
    }
    return count;
  }

  PixelProjector projector_;
  int width_;
  int height_;
  std::vector<float> depth_m_;
};

}  // namespace edgesplat::mapping
