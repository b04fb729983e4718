// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/camera_fields.hpp"

#include <cmath>
#include <numbers>

namespace edgesplat::io {
namespace {

using geometry::CameraKind;
using geometry::CameraModel;

/// What a frame or the whole file says of the camera; the frame's word goes first.
class Intrinsics {
 public:
  Intrinsics(const json::Json& frame, const json::Json& file) : frame_(frame), file_(file) {}

  [[nodiscard]] Result<std::optional<double>> number(std::string_view key) const {
    return json::number(holder_of(key), key);
  }
  [[nodiscard]] Result<double> number_or(std::string_view key, double otherwise) const {
    EDGESPLAT_TRY(const auto value, number(key));
    return value.value_or(otherwise);
  }
  [[nodiscard]] Result<int> size(std::string_view key) const { return size_px(holder_of(key), key); }
  [[nodiscard]] Result<std::optional<std::string>> text(std::string_view key) const {
    return json::text(holder_of(key), key);
  }

 private:
  [[nodiscard]] const json::Json& holder_of(std::string_view key) const {
    return json::find(frame_, key) != nullptr ? frame_ : file_;
  }
  const json::Json& frame_;
  const json::Json& file_;
};

/// From fl_<axis>, else from camera_angle_<axis>; 0 where neither is there.
Result<double> focal_length(const Intrinsics& in, char axis, int size_px) {
  EDGESPLAT_TRY(const auto stated, in.number(std::string("fl_") + axis));
  if (stated) return *stated;
  EDGESPLAT_TRY(const auto angle_rad, in.number(std::string("camera_angle_") + axis));
  if (!angle_rad || *angle_rad <= 0.0 || *angle_rad >= std::numbers::pi) return 0.0;
  return 0.5 * size_px / std::tan(0.5 * *angle_rad);
}

Status read_distortion(const Intrinsics& in, CameraModel& camera) {
  EDGESPLAT_TRY(const double k3, in.number_or("k3", 0.0));
  EDGESPLAT_TRY(const double k4, in.number_or("k4", 0.0));
  EDGESPLAT_TRY(camera.distortion[0], in.number_or("k1", 0.0));
  EDGESPLAT_TRY(camera.distortion[1], in.number_or("k2", 0.0));
  if (camera.kind == CameraKind::kFisheye) {
    camera.distortion[2] = k3;
    camera.distortion[3] = k4;
    return {};
  }
  if (k4 != 0.0)
    return fail(Errc::kCorrupt, "distortion k4 of a pinhole is not supported: undistort the images first");
  camera.k3 = k3;
  EDGESPLAT_TRY(camera.distortion[2], in.number_or("p1", 0.0));
  EDGESPLAT_TRY(camera.distortion[3], in.number_or("p2", 0.0));
  return {};
}

Result<CameraModel> read_camera(const Intrinsics& in) {
  CameraModel camera;
  EDGESPLAT_TRY(const auto model, in.text("camera_model"));
  if (model == "OPENCV_FISHEYE") {
    camera.kind = CameraKind::kFisheye;
  } else if (model && *model != "OPENCV" && *model != "PINHOLE" && *model != "SIMPLE_PINHOLE" &&
             *model != "SIMPLE_RADIAL" && *model != "RADIAL") {
    return fail(Errc::kCorrupt, "camera_model " + model->substr(0, 40) + " is not supported");
  }
  EDGESPLAT_TRY(camera.width_px, in.size("w"));
  EDGESPLAT_TRY(camera.height_px, in.size("h"));
  EDGESPLAT_TRY(camera.fx_px, focal_length(in, 'x', camera.width_px));
  EDGESPLAT_TRY(camera.fy_px, focal_length(in, 'y', camera.height_px));
  if (camera.fx_px <= 0.0) {
    return fail(Errc::kCorrupt, "no focal length: expected \"fl_x\", or \"camera_angle_x\" with \"w\"");
  }
  if (camera.fy_px <= 0.0) camera.fy_px = camera.fx_px;
  EDGESPLAT_TRY(const auto cx, in.number("cx"));
  EDGESPLAT_TRY(const auto cy, in.number("cy"));
  if ((!cx && camera.width_px == 0) || (!cy && camera.height_px == 0)) {
    return fail(Errc::kCorrupt, "no principal point: expected \"cx\" and \"cy\", or \"w\" and \"h\"");
  }
  camera.cx_px = cx.value_or(0.5 * camera.width_px) - 0.5;  // pixel centres at 0.5 -> at 0
  camera.cy_px = cy.value_or(0.5 * camera.height_px) - 0.5;
  EDGESPLAT_TRY_STATUS(read_distortion(in, camera));
  return camera;
}

Result<PosedCamera> read_frame(const json::Json& frame, const json::Json& file) {
  PosedCamera out;
  EDGESPLAT_TRY(const auto image, json::text(frame, "file_path"));
  if (!image || image->empty()) return fail(Errc::kCorrupt, "\"file_path\" is missing");
  out.image = *image;
  EDGESPLAT_TRY(const auto depth, json::text(frame, "depth_file_path"));
  out.depth = depth.value_or("");
  EDGESPLAT_TRY(out.camera, read_camera(Intrinsics(frame, file)));
  EDGESPLAT_TRY(PoseRows pose, pose_rows(frame, "transform_matrix"));
  pose.middleCols<2>(1) *= -1.0;  // OpenGL's camera has y up and looks along -z
  out.map_from_camera = geometry::RigidTransform::from_matrix(pose);
  return out;
}

}  // namespace

Result<CameraSet> parse_nerf_transforms(const json::Json& file) {
  CameraSet set;
  EDGESPLAT_TRY(const auto points, json::text(file, "ply_file_path"));
  set.points = points.value_or("");
  for (const json::Json& frame : *json::find(file, "frames")) {
    auto camera = read_frame(frame, file);
    if (!camera) {
      return fail(Errc::kCorrupt,
                  "frame " + std::to_string(set.cameras.size()) + ": " + camera.error().context);
    }
    set.cameras.push_back(*std::move(camera));
  }
  return set;
}

}  // namespace edgesplat::io
