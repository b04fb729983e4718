// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/accuracy/association.hpp"
#include "tools/quality/saved_keyframes.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace edgesplat::quality {

/// A place from which no keyframe was taken.
struct HeldOutView {
  HostTime stamp{};
  geometry::RigidTransform world_from_camera;  ///< the truth
  geometry::RigidTransform map_from_camera;    ///< the same place in the map, over align_map()
  std::size_t nearest_keyframe = 0;            ///< row of the keyframe whose picture looks most alike
};

/// map_from_world: the mean over all keyframes of where the map and the truth have them (chordal mean of the
/// rotations). Only pairs whose stamp is a keyframe's count. kNotFound where there is none.
[[nodiscard]] Result<geometry::RigidTransform> align_map(std::span<const SavedKeyframe> keyframes,
                                                         std::span<const accuracy::PosePair> truth,
                                                         const geometry::RigidTransform& body_from_camera);

/// Up to `most` true poses, evenly spread, each the one nearest to the middle between two keyframes in a row.
/// `truth`: at the robot's pose stamps, in the keyframes' time, `reference` = world_from_body.
[[nodiscard]] Result<std::vector<HeldOutView>> choose_held_out_views(
    std::span<const SavedKeyframe> keyframes, std::span<const accuracy::PosePair> truth,
    const geometry::RigidTransform& body_from_camera, std::size_t most);

}  // namespace edgesplat::quality
