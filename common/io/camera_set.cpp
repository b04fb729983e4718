// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/camera_set.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/camera_fields.hpp"
#include "common/io/image_file.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <set>

namespace edgesplat::io {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{64} << 20U;
constexpr std::uint64_t kMaxImageBytes = std::uint64_t{256} << 20U;

Result<double> required(const json::Json& object, std::string_view key) {
  EDGESPLAT_TRY(const auto value, json::number(object, key));
  if (!value) return fail(Errc::kCorrupt, "\"" + std::string(key) + "\" is missing");
  return *value;
}

Status read_distortion(const json::Json& object, geometry::CameraModel& camera) {
  const json::Json* field = json::find(object, "distortion");
  if (field == nullptr) return {};
  const std::size_t most = camera.kind == geometry::CameraKind::kPinhole ? 5 : 4;
  const auto is_number = [](const json::Json& value) { return value.is_number(); };
  if (!field->is_array() || field->size() < 4 || field->size() > most ||
      !std::all_of(field->begin(), field->end(), is_number)) {
    return fail(Errc::kCorrupt, "\"distortion\" is not four numbers (five with a pinhole's k3)");
  }
  for (std::size_t i = 0; i < 4; ++i) camera.distortion[i] = (*field)[i].get<double>();
  if (field->size() == 5) camera.k3 = (*field)[4].get<double>();
  return {};
}

Result<PosedCamera> parse_camera(const json::Json& object) {
  PosedCamera out;
  geometry::CameraModel& camera = out.camera;
  EDGESPLAT_TRY(const auto name, json::text(object, "name"));
  EDGESPLAT_TRY(const auto image, json::text(object, "image"));
  EDGESPLAT_TRY(const auto model, json::text(object, "model"));
  out.name = name.value_or("");
  out.image = image.value_or("");
  if (model && *model != "pinhole" && *model != "fisheye") {
    return fail(Errc::kCorrupt, "\"model\" is neither pinhole nor fisheye");
  }
  if (model == "fisheye") camera.kind = geometry::CameraKind::kFisheye;
  EDGESPLAT_TRY(camera.width_px, size_px(object, "width"));
  EDGESPLAT_TRY(camera.height_px, size_px(object, "height"));
  EDGESPLAT_TRY(camera.fx_px, required(object, "fx"));
  EDGESPLAT_TRY(camera.fy_px, required(object, "fy"));
  EDGESPLAT_TRY(camera.cx_px, required(object, "cx"));
  EDGESPLAT_TRY(camera.cy_px, required(object, "cy"));
  EDGESPLAT_TRY_STATUS(read_distortion(object, camera));
  EDGESPLAT_TRY(const auto pose, pose_rows(object, "map_from_camera"));
  out.map_from_camera = geometry::RigidTransform::from_matrix(pose);
  return out;
}

Result<CameraSet> parse_own_form(const json::Json& cameras) {
  CameraSet set;
  for (const json::Json& object : cameras) {
    auto camera = parse_camera(object);
    if (!camera) {
      return fail(Errc::kCorrupt,
                  "camera " + std::to_string(set.cameras.size()) + ": " + camera.error().context);
    }
    set.cameras.push_back(*std::move(camera));
  }
  return set;
}

Status check_cameras(const std::vector<PosedCamera>& cameras) {
  for (const PosedCamera& posed : cameras) {
    geometry::CameraModel camera = posed.camera;
    if (camera.width_px == 0) camera.width_px = 1;  // its image's header will tell
    if (camera.height_px == 0) camera.height_px = 1;
    if (const Status valid = camera.validate(); !valid) {
      return fail(Errc::kCorrupt, posed.name + ": " + valid.error().context);
    }
    if (!posed.map_from_camera.is_finite())
      return fail(Errc::kCorrupt, posed.name + ": the pose is not finite");
  }
  return {};
}

Status take_size_from_image(const std::filesystem::path& set_file, PosedCamera& posed) {
  geometry::CameraModel& camera = posed.camera;
  if (camera.width_px > 0 && camera.height_px > 0) return {};
  if (posed.image.empty()) return fail(Errc::kCorrupt, posed.name + " has neither a size nor an image");
  EDGESPLAT_TRY(const ImageHeader header, read_image_size(image_path(set_file, posed)));
  camera.width_px = header.width_px;
  camera.height_px = header.height_px;
  return {};
}

}  // namespace

Result<ImageHeader> read_image_size(const std::filesystem::path& image) {
  EDGESPLAT_TRY(const auto bytes, read_file(image, kMaxImageBytes));
  auto header = read_image_header(bytes);
  if (!header) return fail(header.error().code, image.string() + ": " + header.error().context);
  return header;
}

void name_cameras(std::vector<PosedCamera>& cameras) {
  std::set<std::string> taken;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    std::string name = cameras[i].name.empty() ? cameras[i].image.stem().string() : cameras[i].name;
    for (char& letter : name) {
      if (letter == '/' || letter == '\0') letter = '_';
    }
    if (name.empty() || name.starts_with('.') || name.size() > 100) name = "view";
    if (taken.contains(name)) name += "_" + std::to_string(i);
    while (!taken.insert(name).second) name += "_";
    cameras[i].name = std::move(name);
  }
}

Result<PoseRows> pose_rows(const json::Json& object, std::string_view key) {
  const json::Json* field = json::find(object, key);
  const auto bad = [key](const std::string& why) {
    return fail(Errc::kCorrupt, "\"" + std::string(key) + "\" " + why);
  };
  if (field == nullptr) return bad("is missing");
  if (!field->is_array() || (field->size() != 3 && field->size() != 4)) return bad("has not 3 or 4 rows");
  PoseRows rows;
  for (std::size_t r = 0; r < 3; ++r) {
    const json::Json& row = (*field)[r];
    if (!row.is_array() || row.size() != 4) return bad("has a row that is not four numbers");
    for (std::size_t c = 0; c < 4; ++c) {
      if (!row[c].is_number()) return bad("has a row that is not four numbers");
      rows(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = row[c].get<double>();
    }
  }
  Eigen::Matrix3d linear = rows.leftCols<3>();
  const double scale = std::cbrt(linear.determinant());
  if (!rows.allFinite() || !(scale > 1e-9)) return bad("is no rotation and translation");
  linear /= scale;
  const bool is_rotation = (linear.transpose() * linear - Eigen::Matrix3d::Identity()).norm() < 0.02;
  if (!is_rotation) return bad("is no rotation and translation");
  rows.leftCols<3>() = linear;
  return rows;
}

Result<int> size_px(const json::Json& object, std::string_view key) {
  EDGESPLAT_TRY(const auto value, json::number(object, key));
  if (!value) return 0;
  if (*value < 1.0 || *value > kMaxImageSide_px || *value != std::floor(*value)) {
    return fail(Errc::kCorrupt, "\"" + std::string(key) + "\" is not 1.." + std::to_string(kMaxImageSide_px));
  }
  return static_cast<int>(*value);
}

Result<CameraSet> parse_camera_set(std::string_view text) {
  EDGESPLAT_TRY(const auto file, json::parse_object(text, "the camera file"));
  const json::Json* cameras = json::find(file, "cameras");
  const json::Json* frames = json::find(file, "frames");
  CameraSet set;
  if (cameras != nullptr && cameras->is_array()) {
    EDGESPLAT_TRY(set, parse_own_form(*cameras));
  } else if (frames != nullptr && frames->is_array()) {
    EDGESPLAT_TRY(set, parse_nerf_transforms(file));
  } else {
    return fail(Errc::kCorrupt, "the camera file has neither \"cameras\" nor \"frames\"");
  }
  if (set.cameras.empty()) return fail(Errc::kCorrupt, "the camera file names no camera");
  name_cameras(set.cameras);
  EDGESPLAT_TRY_STATUS(check_cameras(set.cameras));
  return set;
}

Result<CameraSet> read_camera_set(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const auto text, read_text_file(path, kMaxFileBytes));
  auto set = parse_camera_set(text);
  if (!set) return fail(set.error().code, path.string() + ": " + set.error().context);
  for (PosedCamera& camera : set->cameras) EDGESPLAT_TRY_STATUS(take_size_from_image(path, camera));
  return set;
}

std::filesystem::path image_path(const std::filesystem::path& set_file, const PosedCamera& camera) {
  std::filesystem::path stated = set_file.parent_path() / camera.image;
  if (camera.image.has_extension()) return stated;
  std::error_code ignored;
  for (const char* ending : {".png", ".jpg"}) {
    if (std::filesystem::exists(stated.string() + ending, ignored)) return stated.string() + ending;
  }
  return stated;
}

}  // namespace edgesplat::io
