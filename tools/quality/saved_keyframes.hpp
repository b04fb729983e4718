// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/camera_model.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/time/time.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace edgesplat::quality {

/// A keyframe, or a picture held out of mapping, as the robot left it in its run folder.
struct SavedKeyframe {
  HostTime stamp{};
  geometry::RigidTransform map_from_camera;
  geometry::CameraModel camera;  ///< pinhole without distortion
  std::filesystem::path image;   ///< undistorted
  std::optional<int> block;      ///< of a picture held out of mapping: which pictures in a row it is one of
};

/// Those of `folder` (robot/keyframes or robot/heldout of a run) in the order of their stamps. kCorrupt names
/// the file that cannot be read; kNotFound where there is none.
[[nodiscard]] Result<std::vector<SavedKeyframe>> read_saved_keyframes(const std::filesystem::path& folder);

}  // namespace edgesplat::quality
