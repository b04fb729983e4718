// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/sh_rotation.hpp"
#include "common/map/delta.hpp"

#include <span>
#include <unordered_map>

namespace edgesplat::map {

/// How anchored Gaussians move when keyframe poses are corrected: by new * old^-1 of their keyframe. The sums
/// are plain doubles in a fixed order, so that robot and server come to the same bits.
class Repose {
 public:
  explicit Repose(std::span<const PoseCorrection> corrections);

  /// Moves a quantised Gaussian and turns its colours with it; its anchor gets the new version, its chunk is
  /// as of chunk_after_move. False, and nothing changes, where its anchor is not among the corrections or has
  /// their version or a later one.
  bool move(QuantisedRows& rows, std::size_t row) const;
  /// The same for the server's floats.
  bool move(gaussian::GaussianCloud& cloud, std::size_t row) const;

 private:
  struct Motion {
    std::uint32_t version;
    std::array<double, 4> quat_xyzw;  ///< new_from_old
    std::array<double, 9> rotation;   ///< the same, row-major
    std::array<double, 3> translation_m;
    gaussian::ShRotation sh;

    [[nodiscard]] DecodedPose operator*(const DecodedPose& pose) const;
  };
  [[nodiscard]] const Motion* motion_of(const gaussian::Anchor& anchor) const;

  std::unordered_map<std::uint32_t, Motion> motions_;  ///< by keyframe
};

}  // namespace edgesplat::map
