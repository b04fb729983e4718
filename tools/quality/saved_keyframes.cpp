// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/quality/saved_keyframes.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <system_error>

namespace edgesplat::quality {
namespace {

SavedKeyframe keyframe_of(const nlohmann::json& json) {
  SavedKeyframe keyframe;
  keyframe.stamp = host_time_from_ns(json.at("stamp_ns").get<std::int64_t>());
  const auto t = json.at("map_from_camera").at("translation_m").get<std::array<double, 3>>();
  const auto q = json.at("map_from_camera").at("quaternion_xyzw").get<std::array<double, 4>>();
  keyframe.map_from_camera.translation_m = {t[0], t[1], t[2]};
  keyframe.map_from_camera.rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized();
  const auto& camera = json.at("camera");
  keyframe.camera.width_px = camera.at("width_px").get<int>();
  keyframe.camera.height_px = camera.at("height_px").get<int>();
  keyframe.camera.fx_px = camera.at("fx_px").get<double>();
  keyframe.camera.fy_px = camera.at("fy_px").get<double>();
  keyframe.camera.cx_px = camera.at("cx_px").get<double>();
  keyframe.camera.cy_px = camera.at("cy_px").get<double>();
  if (json.contains("block")) keyframe.block = json.at("block").get<int>();
  return keyframe;
}

Result<SavedKeyframe> read_one(const std::filesystem::path& path) {
  std::ifstream file(path);
  try {
    SavedKeyframe keyframe = keyframe_of(nlohmann::json::parse(file));
    if (!keyframe.map_from_camera.is_finite())
      return fail(Errc::kCorrupt, path.string() + ": pose not finite");
    keyframe.image = path;
    keyframe.image.replace_extension(".jpg");
    return keyframe;
  } catch (const nlohmann::json::exception& error) {
    return fail(Errc::kCorrupt, path.string() + ": " + error.what());
  }
}

}  // namespace

Result<std::vector<SavedKeyframe>> read_saved_keyframes(const std::filesystem::path& folder) {
  std::vector<SavedKeyframe> keyframes;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() != ".json") continue;
    EDGESPLAT_TRY(SavedKeyframe keyframe, read_one(it->path()));
    keyframes.push_back(std::move(keyframe));
  }
  if (keyframes.empty()) {
    return fail(Errc::kNotFound,
                "no keyframes in " + folder.string() + ": run the robot with --out and a camera");
  }
  std::sort(keyframes.begin(), keyframes.end(),
            [](const SavedKeyframe& a, const SavedKeyframe& b) { return a.stamp < b.stamp; });
  return keyframes;
}

}  // namespace edgesplat::quality
