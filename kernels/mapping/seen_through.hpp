// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "kernels/mapping/depth_picture.hpp"

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace edgesplat::mapping {

struct SeenThroughOptions {
  bool enabled = true;
  LookThrough by;
  int votes = 1;  ///< views that must agree, 1..100
};

/// Finds what is not there any more: Gaussians through which the LiDAR has measured something behind, in
/// several views. People who walked through leave such Gaussians behind. Single-owner.
class SeenThrough {
 public:
  explicit SeenThrough(const SeenThroughOptions& options) : options_(options) {}

  /// Rows of `cloud` that this view finds gone for good, ascending. Gaussians anchored to the view's own
  /// keyframe are not judged by it. O(Gaussians + pixels).
  [[nodiscard]] std::vector<std::uint32_t> take(const StoredView& view, const gaussian::GaussianCloud& cloud);
  /// Gaussians with votes against them but not yet enough.
  [[nodiscard]] std::size_t suspects() const { return votes_.size(); }

 private:
  SeenThroughOptions options_;
  std::unordered_map<gaussian::GaussianId, int> votes_;
};

}  // namespace edgesplat::mapping
