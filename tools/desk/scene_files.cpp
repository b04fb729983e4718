// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/scene_files.hpp"

#include "common/io/colmap_model.hpp"

#include <string>

namespace edgesplat::desk {
namespace {

/// Without a slash at its end, so that parent_path() is the folder above.
std::filesystem::path plain(const std::filesystem::path& path) {
  const std::filesystem::path whole = std::filesystem::absolute(path).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

std::filesystem::path images_of(const std::filesystem::path& folder, const std::filesystem::path& model) {
  const std::filesystem::path inner = plain(model);
  std::error_code ignored;
  for (const auto& above : {folder, inner.parent_path(), inner.parent_path().parent_path()}) {
    if (std::filesystem::is_directory(above / "images", ignored)) return above / "images";
  }
  return folder / "images";
}

}  // namespace

Result<SceneFiles> find_scene_files(const std::filesystem::path& folder,
                                    const std::filesystem::path& images) {
  std::error_code error;
  const bool is_folder = std::filesystem::is_directory(folder, error);
  const std::filesystem::path transforms = is_folder ? folder / "transforms.json" : folder;
  SceneFiles files;
  if (std::filesystem::exists(transforms, error)) {
    files.set_file = transforms;
    EDGESPLAT_TRY(files.cameras, io::read_camera_set(transforms));
    return files;
  }
  const auto model = io::find_colmap_model(folder);
  if (!model) {
    return fail(Errc::kNotFound, folder.string() +
                                     " is no scene: it has neither a transforms.json (nerfstudio) nor "
                                     "sparse/0 with cameras and images as .bin or .txt (COLMAP)");
  }
  EDGESPLAT_TRY(files.cameras, io::read_colmap(*model, images.empty() ? images_of(folder, *model) : images));
  return files;
}

}  // namespace edgesplat::desk
