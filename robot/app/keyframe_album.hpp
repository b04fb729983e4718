// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "common/map/keyframe.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace edgesplat::app {

/// A bounded, evenly spread sample of the run's keyframes, for the report: when full, every other one is let
/// go and the stride doubles. Single-owner.
class KeyframeAlbum {
 public:
  explicit KeyframeAlbum(std::size_t max_keyframes) : max_keyframes_(max_keyframes) {}

  void add(std::shared_ptr<const map::Keyframe> keyframe);
  [[nodiscard]] std::size_t size() const { return keyframes_.size(); }

  /// Writes keyframes/NNNNNN.jpg (undistorted), _overlay.png (points projected), .json (pose, camera) and
  /// renders/NNNNNN.png (`cloud` drawn from the same pose) into `folder`. Keyframes without a picture are
  /// left out. Errors: kIo, kCorrupt (a picture that no longer decodes).
  [[nodiscard]] Status write(const std::filesystem::path& folder, const gaussian::GaussianCloud& cloud,
                             const geometry::RigidTransform& map_from_odom) const;

 private:
  std::size_t max_keyframes_;
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;
  std::vector<std::shared_ptr<const map::Keyframe>> keyframes_;
};

}  // namespace edgesplat::app
