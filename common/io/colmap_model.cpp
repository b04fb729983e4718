// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/colmap_model.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/camera_fields.hpp"
#include "common/io/image_file.hpp"

#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>

namespace edgesplat::io {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30U;  // features are most of images.bin

bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

struct ColmapFile {
  std::filesystem::path path;
  ColmapForm form;
};

/// NAME.bin, else NAME.txt (which may not exist).
ColmapFile file_of(const std::filesystem::path& model, const std::string& name) {
  if (is_file(model / (name + ".bin"))) return {model / (name + ".bin"), ColmapForm::kBinary};
  return {model / (name + ".txt"), ColmapForm::kText};
}

/// What `parse`(bytes) makes of the file; errors get its name.
template <typename Parse>
auto read_with(const std::filesystem::path& path, Parse parse) -> decltype(parse({})) {
  EDGESPLAT_TRY(const auto bytes, read_file(path, kMaxFileBytes));
  auto parsed = parse(bytes);
  if (!parsed) return fail(parsed.error().code, path.string() + ": " + parsed.error().context);
  return parsed;
}

/// The same view, larger or smaller: but for rounding, the sides keep their proportion.
bool is_scaled(const geometry::CameraModel& camera, const ImageHeader& image) {
  constexpr double kRounding_px = 1.5;
  const double of_height = static_cast<double>(image.height_px) / camera.height_px;
  const double of_width = static_cast<double>(image.width_px) / camera.width_px;
  return std::abs(camera.width_px * of_height - image.width_px) <= kRounding_px ||
         std::abs(camera.height_px * of_width - image.height_px) <= kRounding_px;
}

/// Images of another size than the camera's: images_2, images_4 and so on hold the same, smaller.
Status fit_to_image(PosedCamera& posed) {
  if (!is_file(posed.image)) return {};  // missing images are told by who wants to see them
  EDGESPLAT_TRY(const ImageHeader header, read_image_size(posed.image));
  if (is_scaled(posed.camera, header))
    posed.camera = posed.camera.scaled_to(header.width_px, header.height_px);
  return {};
}

}  // namespace

std::optional<std::filesystem::path> find_colmap_model(const std::filesystem::path& folder) {
  for (const char* place : {"sparse/0", "sparse", "colmap/sparse/0", "colmap/sparse", ""}) {
    std::filesystem::path model = folder / place;
    if (is_file(file_of(model, "cameras").path) && is_file(file_of(model, "images").path)) return model;
  }
  return std::nullopt;
}

Result<CameraSet> read_colmap(const std::filesystem::path& model, const std::filesystem::path& images) {
  const ColmapFile cameras_file = file_of(model, "cameras");
  const ColmapFile images_file = file_of(model, "images");
  EDGESPLAT_TRY(const auto cameras, read_with(cameras_file.path, [&](std::span<const std::byte> bytes) {
                  return parse_colmap_cameras(bytes, cameras_file.form);
                }));
  CameraSet set;
  EDGESPLAT_TRY(set.cameras, read_with(images_file.path, [&](std::span<const std::byte> bytes) {
                  return parse_colmap_images(bytes, images_file.form, cameras);
                }));
  if (set.cameras.empty()) return fail(Errc::kCorrupt, images_file.path.string() + " names no image");
  name_cameras(set.cameras);
  for (PosedCamera& posed : set.cameras) {
    posed.image = images / posed.image;
    EDGESPLAT_TRY_STATUS(fit_to_image(posed));
  }
  for (const char* name : {"points3D.bin", "points3D.txt", "points3D.ply"}) {
    if (set.points.empty() && is_file(model / name)) set.points = model / name;
  }
  return set;
}

Result<PointCloud> read_points(const std::filesystem::path& path) {
  if (path.extension() != ".bin" && path.extension() != ".txt") return read_points_ply(path);
  const ColmapForm form = path.extension() == ".bin" ? ColmapForm::kBinary : ColmapForm::kText;
  return read_with(path,
                   [form](std::span<const std::byte> bytes) { return parse_colmap_points(bytes, form); });
}

}  // namespace edgesplat::io
