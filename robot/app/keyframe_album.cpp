// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/keyframe_album.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/image_file.hpp"
#include "kernels/image/undistort.hpp"
#include "robot/render/draw_points.hpp"
#include "robot/render/view.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <optional>
#include <string>

namespace edgesplat::app {
namespace {

constexpr double kOverlayRangeM = 40.0;

nlohmann::json pose_json(const geometry::RigidTransform& b_from_a) {
  const auto& t = b_from_a.translation_m;
  const auto& q = b_from_a.rotation;
  return {{"translation_m", {t.x(), t.y(), t.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

nlohmann::json describe(const map::Keyframe& keyframe, const geometry::CameraModel& pinhole,
                        const geometry::RigidTransform& map_from_camera) {
  return {{"keyframe", keyframe.id.value},
          {"stamp_ns", to_ns(keyframe.stamp)},
          {"map_from_camera", pose_json(map_from_camera)},
          {"camera",
           {{"width_px", pinhole.width_px},
            {"height_px", pinhole.height_px},
            {"fx_px", pinhole.fx_px},
            {"fy_px", pinhole.fy_px},
            {"cx_px", pinhole.cx_px},
            {"cy_px", pinhole.cy_px}}}};
}

geometry::RigidTransform map_from_camera(const map::Keyframe& keyframe,
                                         const geometry::RigidTransform& map_from_odom) {
  return map_from_odom * keyframe.odom_from_body * keyframe.camera->body_from_camera;
}

std::string number_name(std::size_t number) {
  char name[24];
  std::snprintf(name, sizeof name, "%06zu", number);
  return name;
}

/// Writes `stem`.jpg and .json. The camera is the same all the run. `block`: of a picture held out.
Status write_picture(const map::Keyframe& keyframe, const image::Undistorter& undistorter,
                     const std::filesystem::path& stem, const geometry::RigidTransform& map_from_odom,
                     std::optional<int> block = {}) {
  EDGESPLAT_TRY(const sensor::ImageRgb8 picture, io::decode_rgb8(keyframe.image->bytes));
  EDGESPLAT_TRY_STATUS(io::save_image(stem.string() + ".jpg", undistorter.apply(picture)));
  nlohmann::json words = describe(keyframe, undistorter.model(), map_from_camera(keyframe, map_from_odom));
  if (block) words["block"] = *block;
  return io::write_file_atomically(stem.string() + ".json", words.dump(1));
}

Status write_overlay_and_render(const map::Keyframe& keyframe, const geometry::CameraModel& pinhole,
                                const std::filesystem::path& folder, const gaussian::GaussianCloud& cloud,
                                const geometry::RigidTransform& map_from_odom) {
  EDGESPLAT_TRY(sensor::ImageRgb8 overlay, io::decode_rgb8(keyframe.image->bytes));
  render::draw_points_by_depth(keyframe.points_in_body, keyframe.camera->body_from_camera.inverse(),
                               keyframe.camera->model, kOverlayRangeM, overlay);
  const std::string number = number_name(keyframe.id.value);
  EDGESPLAT_TRY_STATUS(io::save_image(folder / "keyframes" / (number + "_overlay.png"), overlay));
  EDGESPLAT_TRY(const render::View view,
                render::draw_view(cloud, pinhole, map_from_camera(keyframe, map_from_odom).inverse()));
  return io::save_image(folder / "renders" / (number + ".png"), view.picture);
}

/// Writes `stem`_patches.csv, the places being those in the undistorted picture; none where there are none.
Status write_patches(const std::vector<tracking::TrackedPatch>& patches, const geometry::CameraModel& camera,
                     const geometry::CameraModel& pinhole, const std::filesystem::path& stem) {
  if (patches.empty()) return {};
  std::string csv = "x_px,y_px,side_px,misfit,used\n";
  for (const tracking::TrackedPatch& patch : patches) {
    const auto pixel = pinhole.project(camera.unproject(patch.pixel.cast<double>()));
    if (!pixel || !pinhole.contains(*pixel)) continue;
    csv += fmt::format("{:.1f},{:.1f},{:.0f},{:.2f},{}\n", pixel->x(), pixel->y(), patch.side_px,
                       patch.misfit, patch.used ? 1 : 0);
  }
  return io::write_file_atomically(stem.string() + "_patches.csv", csv);
}

}  // namespace

void KeyframeAlbum::add(std::shared_ptr<const map::Keyframe> keyframe,
                        std::vector<tracking::TrackedPatch> patches) {
  if (!keyframe->image || !keyframe->camera) return;
  auto without_points = std::make_shared<map::Keyframe>();
  without_points->id = keyframe->id;
  without_points->stamp = keyframe->stamp;
  without_points->odom_from_body = keyframe->odom_from_body;
  without_points->camera = keyframe->camera;
  without_points->image = keyframe->image;
  pictures_.add(std::move(without_points));
  whole_.add({std::move(keyframe), std::move(patches)});
}

void KeyframeAlbum::add_held_out(std::shared_ptr<const map::Keyframe> held_out, int block) {
  if (held_out->image && held_out->camera) held_out_.add({std::move(held_out), block});
}

Status KeyframeAlbum::write(const std::filesystem::path& folder, const gaussian::GaussianCloud& cloud,
                            const geometry::RigidTransform& map_from_odom) const {
  std::error_code error;
  for (const char* sub : {"keyframes", "renders", "heldout"}) {
    std::filesystem::create_directories(folder / sub, error);
    if (error) return fail(Errc::kIo, "cannot create " + (folder / sub).string() + ": " + error.message());
  }
  if (pictures_.kept().empty()) return {};
  const image::Undistorter undistorter(pictures_.kept().front()->camera->model);
  for (const auto& keyframe : pictures_.kept()) {
    EDGESPLAT_TRY_STATUS(write_picture(
        *keyframe, undistorter, folder / "keyframes" / number_name(keyframe->id.value), map_from_odom));
  }
  for (std::size_t i = 0; i < held_out_.kept().size(); ++i) {
    const auto& [picture, block] = held_out_.kept()[i];
    EDGESPLAT_TRY_STATUS(
        write_picture(*picture, undistorter, folder / "heldout" / number_name(i), map_from_odom, block));
  }
  for (const auto& [keyframe, patches] : whole_.kept()) {
    EDGESPLAT_TRY_STATUS(write_patches(patches, keyframe->camera->model, undistorter.model(),
                                       folder / "keyframes" / number_name(keyframe->id.value)));
    EDGESPLAT_TRY_STATUS(
        write_overlay_and_render(*keyframe, undistorter.model(), folder, cloud, map_from_odom));
  }
  return {};
}

}  // namespace edgesplat::app
