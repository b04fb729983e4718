// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/keyframe_album.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/image_file.hpp"
#include "robot/render/draw_points.hpp"
#include "robot/render/undistort.hpp"
#include "robot/render/view.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>

namespace edgesplat::app {
namespace {

constexpr double kOverlayRangeM = 40.0;

nlohmann::json pose_json(const geometry::RigidTransform& b_from_a) {
  const auto& t = b_from_a.translation_m;
  const auto& q = b_from_a.rotation;
  return {{"translation_m", {t.x(), t.y(), t.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

std::string describe(const map::Keyframe& keyframe, const geometry::CameraModel& pinhole,
                     const geometry::RigidTransform& map_from_camera) {
  return nlohmann::json{{"keyframe", keyframe.id.value},
                        {"stamp_ns", to_ns(keyframe.stamp)},
                        {"map_from_camera", pose_json(map_from_camera)},
                        {"camera",
                         {{"width_px", pinhole.width_px},
                          {"height_px", pinhole.height_px},
                          {"fx_px", pinhole.fx_px},
                          {"fy_px", pinhole.fy_px},
                          {"cx_px", pinhole.cx_px},
                          {"cy_px", pinhole.cy_px}}},
                        {"points", keyframe.points_in_body.size()}}
      .dump(1);
}

Status write_one(const map::Keyframe& keyframe, const std::filesystem::path& folder,
                 const gaussian::GaussianCloud& cloud, const geometry::RigidTransform& map_from_odom) {
  char name[16];
  std::snprintf(name, sizeof name, "%06u", keyframe.id.value);
  const geometry::CameraModel& camera = keyframe.camera->model;
  const geometry::CameraModel pinhole = render::undistorted_model(camera);
  const geometry::RigidTransform map_from_camera =
      map_from_odom * keyframe.odom_from_body * keyframe.camera->body_from_camera;

  EDGESPLAT_TRY(const sensor::ImageRgb8 picture, io::decode_rgb8(keyframe.image->bytes));
  const std::string stem = (folder / "keyframes" / name).string();
  EDGESPLAT_TRY_STATUS(io::save_image(stem + ".jpg", render::undistort(picture, camera)));
  EDGESPLAT_TRY_STATUS(
      io::write_file_atomically(stem + ".json", describe(keyframe, pinhole, map_from_camera)));

  sensor::ImageRgb8 overlay = picture;
  render::draw_points_by_depth(keyframe.points_in_body, keyframe.camera->body_from_camera.inverse(), camera,
                               kOverlayRangeM, overlay);
  EDGESPLAT_TRY_STATUS(io::save_image(stem + "_overlay.png", overlay));

  EDGESPLAT_TRY(const render::View view, render::draw_view(cloud, pinhole, map_from_camera.inverse()));
  return io::save_image(folder / "renders" / (std::string(name) + ".png"), view.picture);
}

}  // namespace

void KeyframeAlbum::add(std::shared_ptr<const map::Keyframe> keyframe) {
  if (!keyframe->image || !keyframe->camera) return;
  if (seen_++ % stride_ != 0) return;
  if (keyframes_.size() >= max_keyframes_) {
    for (std::size_t i = 0; 2 * i < keyframes_.size(); ++i) keyframes_[i] = std::move(keyframes_[2 * i]);
    keyframes_.resize((keyframes_.size() + 1) / 2);
    stride_ *= 2;
    if ((seen_ - 1) % stride_ != 0) return;
  }
  keyframes_.push_back(std::move(keyframe));
}

Status KeyframeAlbum::write(const std::filesystem::path& folder, const gaussian::GaussianCloud& cloud,
                            const geometry::RigidTransform& map_from_odom) const {
  std::error_code error;
  for (const char* sub : {"keyframes", "renders"}) {
    std::filesystem::create_directories(folder / sub, error);
    if (error) return fail(Errc::kIo, "cannot create " + (folder / sub).string() + ": " + error.message());
  }
  for (const auto& keyframe : keyframes_) {
    EDGESPLAT_TRY_STATUS(write_one(*keyframe, folder, cloud, map_from_odom));
  }
  return {};
}

}  // namespace edgesplat::app
