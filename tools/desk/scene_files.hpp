// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/camera_set.hpp"

#include <filesystem>

namespace edgesplat::desk {

/// What a scene's folder names; no picture is opened but for its size.
struct SceneFiles {
  io::CameraSet cameras;
  std::filesystem::path set_file;  ///< what the set's paths are relative to, as io::image_path() wants it
};

/// `folder`: nerfstudio's, with a transforms.json (or that file itself, or a set of cameras of ours); else
/// COLMAP's, with sparse/0/{cameras,images,points3D}.{bin,txt} (or colmap/sparse/0, sparse, or that folder
/// itself). `images`: where COLMAP's images lie; empty: in images/ of the folder, or of one of the two above
/// the reconstruction. Errors: kNotFound says what was looked for; those of reading it.
[[nodiscard]] Result<SceneFiles> find_scene_files(const std::filesystem::path& folder,
                                                  const std::filesystem::path& images);

}  // namespace edgesplat::desk
