// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/accuracy/association.hpp"
#include "tools/quality/saved_keyframes.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::quality {

/// A place from which no keyframe was taken.
struct HeldOutView {
  HostTime stamp{};
  geometry::RigidTransform map_from_camera;
  std::size_t nearest_keyframe = 0;            ///< row of most_alike()
  geometry::RigidTransform world_from_camera;  ///< the truth; only of a simulated run
  std::filesystem::path picture;               ///< what the camera saw; only where it was held out of mapping
  std::optional<int> block;                    ///< of that picture
};

/// Row of the keyframe whose picture looks most alike, by its pose; there must be one.
[[nodiscard]] std::size_t most_alike(std::span<const SavedKeyframe> keyframes,
                                     const geometry::RigidTransform& map_from_camera);

/// map_from_world: the mean over all keyframes of where the map and the truth have them (chordal mean of the
/// rotations). Only pairs whose stamp is a keyframe's count. kNotFound where there is none.
[[nodiscard]] Result<geometry::RigidTransform> align_map(std::span<const SavedKeyframe> keyframes,
                                                         std::span<const accuracy::PosePair> truth,
                                                         const geometry::RigidTransform& body_from_camera);

/// Simulated runs: up to `most` true poses, evenly spread, each the one nearest to the middle between two
/// keyframes in a row. `truth`: at the robot's pose stamps, in the keyframes' time, `reference` =
/// world_from_body.
[[nodiscard]] Result<std::vector<HeldOutView>> choose_held_out_views(
    std::span<const SavedKeyframe> keyframes, std::span<const accuracy::PosePair> truth,
    const geometry::RigidTransform& body_from_camera, std::size_t most);

/// Real runs: up to `most` of the pictures held out of mapping, evenly spread, from the poses that the robot
/// tracked. kCorrupt where one of them is a keyframe as well: the map would be judged by what it was made of.
/// There must be a keyframe.
[[nodiscard]] Result<std::vector<HeldOutView>> views_of_pictures(std::span<const SavedKeyframe> keyframes,
                                                                 std::span<const SavedKeyframe> held_out,
                                                                 std::size_t most);

}  // namespace edgesplat::quality
