// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace edgesplat::desk {

struct SceneExport {
  std::filesystem::path recording;  ///< simulated, with a camera whose clock is disciplined
  std::filesystem::path folder;     ///< is made; what is there under the same names is replaced
  std::size_t pictures = 60;        ///< at most, evenly over the recording
  std::size_t points = 20'000;      ///< of the point cloud, at most
  std::uint64_t seed = 1;           ///< decides which pixels become points
};

struct SceneExportReport {
  std::size_t pictures = 0;
  std::size_t points = 0;
};

/// Writes a simulated recording as a scene that `train` and nerfstudio read: images/NNNNNN.png without movers
/// and brought to one exposure, depth/NNNNNN.png (16 bits, mm along the camera's z), points.ply with coloured
/// points of the depth pictures, transforms.json with the true poses and the camera with its distortion. The
/// same recording gives the same scene. Errors: kNotFound (no such recording, no clean pictures, no poses in
/// it), kInvalidArgument (no picture or a camera with a free clock), kCorrupt, kIo.
[[nodiscard]] Result<SceneExportReport> export_scene(const SceneExport& options);

}  // namespace edgesplat::desk
