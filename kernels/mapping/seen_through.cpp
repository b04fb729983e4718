// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/seen_through.hpp"

#include "kernels/mapping/pixel_projector.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::mapping {
namespace {

constexpr float kNearest_m = 0.2F;

/// The depths of a view as a picture to look around in.
class DepthPicture {
 public:
  explicit DepthPicture(const StoredView& view)
      : width_(view.camera().width_px),
        height_(view.camera().height_px),
        depth_m_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0F) {
    for (const SparseDepth& d : view.depths) depth_m_[d.pixel] = d.depth_m;
  }

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

 private:
  int width_;
  int height_;
  std::vector<float> depth_m_;
};

}  // namespace

std::vector<std::uint32_t> SeenThrough::take(const StoredView& view, const gaussian::GaussianCloud& cloud) {
  const DepthPicture picture(view);
  const PixelProjector projector(view.map_from_camera.inverse(), view.camera());
  std::vector<std::uint32_t> gone;
  if (votes_.size() > cloud.size()) votes_.clear();  // mostly of Gaussians that went for other reasons
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    if (cloud.anchors[row].keyframe == view.keyframe.value) continue;
    const auto hit =
        projector.project(Eigen::Map<const Eigen::Vector3f>(&cloud.means_m[3 * row]), kNearest_m);
    if (!hit) continue;
    const float beyond_m = hit->depth_m + options_.margin_m + options_.margin_per_range * hit->depth_m;
    const int rays = picture.rays_beyond(hit->x, hit->y, options_.reach_px, beyond_m);
    if (rays < options_.least_rays) continue;
    if (++votes_[cloud.ids[row]] < options_.votes) continue;
    votes_.erase(cloud.ids[row]);
    gone.push_back(static_cast<std::uint32_t>(row));
  }
  return gone;
}

}  // namespace edgesplat::mapping
