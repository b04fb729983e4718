// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/seen_through.hpp"

namespace edgesplat::mapping {

std::vector<std::uint32_t> SeenThrough::take(const StoredView& view, const gaussian::GaussianCloud& cloud) {
  const DepthPicture picture(view);
  std::vector<std::uint32_t> gone;
  if (votes_.size() > cloud.size()) votes_.clear();  // mostly of Gaussians that went for other reasons
  for (std::size_t row = 0; row < cloud.size(); ++row) {
    if (cloud.anchors[row].keyframe == view.keyframe.value) continue;
    const Eigen::Map<const Eigen::Vector3f> mean(&cloud.means_m[3 * row]);
    if (!picture.looks_through(mean, options_.by)) continue;
    if (++votes_[cloud.ids[row]] < options_.votes) continue;
    votes_.erase(cloud.ids[row]);
    gone.push_back(static_cast<std::uint32_t>(row));
  }
  return gone;
}

}  // namespace edgesplat::mapping
