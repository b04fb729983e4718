// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "common/map/keyframe.hpp"
#include "robot/app/even_sample.hpp"
#include "robot/tracking/tracked_group.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace edgesplat::app {

/// The run's keyframes for the report: the pictures of nearly all (up to 1024, some 20 MB), and a few whole
/// ones. Single-owner.
class KeyframeAlbum {
 public:
  explicit KeyframeAlbum(std::size_t max_keyframes) : whole_(max_keyframes) {}

  /// `patches`: what tracking held its picture against, for the report.
  void add(std::shared_ptr<const map::Keyframe> keyframe, std::vector<tracking::TrackedPatch> patches = {});
  /// A picture that the map did not get (up to 256), and which block of them it belongs to.
  void add_held_out(std::shared_ptr<const map::Keyframe> held_out, int block);
  [[nodiscard]] std::size_t size() const { return whole_.kept().size(); }

  /// Writes keyframes/NNNNNN.jpg (undistorted) and .json (pose, camera) into `folder`, for the whole ones
  /// also keyframes/NNNNNN_overlay.png (points projected), keyframes/NNNNNN_patches.csv (where tracking's
  /// patches lie in NNNNNN.jpg and how well they fit; at most one a cell of the picture, so some 10 KB) and
  /// renders/NNNNNN.png (`cloud` drawn from the same pose); for what was held out heldout/NNNNNN.{jpg,json},
  /// counted from 0. Keyframes without a picture are left out. Errors: kIo, kCorrupt (a picture that no
  /// longer decodes).
  [[nodiscard]] Status write(const std::filesystem::path& folder, const gaussian::GaussianCloud& cloud,
                             const geometry::RigidTransform& map_from_odom) const;

 private:
  struct Whole {
    std::shared_ptr<const map::Keyframe> keyframe;
    std::vector<tracking::TrackedPatch> patches;
  };
  EvenSample<Whole> whole_;
  EvenSample<std::shared_ptr<const map::Keyframe>> pictures_{1024};  ///< without their points
  struct HeldOut {
    std::shared_ptr<const map::Keyframe> picture;
    int block;
  };
  EvenSample<HeldOut> held_out_{256};
};

}  // namespace edgesplat::app
