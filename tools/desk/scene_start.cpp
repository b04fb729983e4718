// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/scene_start.hpp"

#include "common/thread/parallel_for.hpp"
#include "kernels/mapping/neighbour_grid.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::desk {
namespace {

/// Neighbours are looked for within shares of the scene's extent that double from the first to the last.
constexpr float kFirstReach = 1.0F / 1024.0F;
constexpr float kLastReach = 1.0F / 16.0F;
constexpr std::size_t kNeighbours = 3;  // besides the point itself

/// Root mean square distance to the nearest neighbours, `reach` where there are fewer.
std::vector<float> spacings(std::span<const Eigen::Vector3f> points, float extent) {
  std::vector<float> spacing(points.size(), kLastReach * extent);
  std::vector<std::size_t> open(points.size());
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = i;
  for (float reach = kFirstReach; reach <= kLastReach && !open.empty(); reach *= 2.0F) {
    const mapping::NeighbourGrid grid(points, reach * extent);
    std::vector<char> found(open.size(), 0);
    thread::parallel_for(std::size_t{0}, open.size(), [&](std::size_t i) {
      const auto near = grid.nearest(points[open[i]]);
      if (near.count <= kNeighbours) return;
      float sum = 0.0F;
      for (std::size_t k = 1; k <= kNeighbours; ++k) sum += near.squared_m2[k];
      spacing[open[i]] = std::sqrt(sum / static_cast<float>(kNeighbours));
      found[i] = 1;
    });
    std::size_t left = 0;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (found[i] == 0) open[left++] = open[i];
    }
    open.resize(left);
  }
  return spacing;
}

}  // namespace

gaussian::GaussianCloud gaussians_of_points(const io::PointCloud& points, const StartOptions& options,
                                            mapping::IdAllocator& ids) {
  std::vector<Eigen::Vector3f> means;
  std::vector<std::size_t> rows;
  const std::size_t count = std::min(points.points_m.size(), options.most);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = k * points.points_m.size() / count;
    if (!points.points_m[i].allFinite()) continue;
    means.push_back(points.points_m[i]);
    rows.push_back(i);
  }
  const auto scale = static_cast<float>(options.extent);
  const auto spacing = spacings(means, scale);
  gaussian::GaussianCloud cloud;
  cloud.resize(means.size());
  for (std::size_t row = 0; row < means.size(); ++row) {
    cloud.ids[row] = ids.next();
    const float log_scale = std::log(std::max(spacing[row], 1e-5F * scale));
    for (std::size_t i = 0; i < 3; ++i) {
      cloud.means_m[3 * row + i] = means[row][static_cast<Eigen::Index>(i)];
      cloud.log_scales[3 * row + i] = log_scale;
      const float colour = points.rgb.empty() ? 0.5F : static_cast<float>(points.rgb[rows[row]][i]) / 255.0F;
      cloud.sh[3 * row + i] = (colour - 0.5F) / gaussian::GaussianCloud::kShC0;
    }
    cloud.quats_xyzw[4 * row + 3] = 1.0F;
    cloud.opacity_logits[row] = std::log(options.opacity / (1.0F - options.opacity));
  }
  return cloud;
}

}  // namespace edgesplat::desk
