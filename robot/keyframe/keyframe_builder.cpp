// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/keyframe_builder.hpp"

#include "common/io/image_file.hpp"
#include "robot/keyframe/thin_points.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::keyframe {
namespace {

std::vector<map::ColouredPoint> grey_points(const tracking::TrackedGroup& group) {
  std::vector<map::ColouredPoint> points;
  points.reserve(group.points_in_body.size());
  for (const tracking::DeskewedPoint& p : group.points_in_body) {
    const auto grey =
        static_cast<std::uint8_t>(std::lround(40.0F + 200.0F * std::clamp(p.reflectivity, 0.0F, 1.0F)));
    points.push_back({p.p_in_body_m, {grey, grey, grey}, true});
  }
  return points;
}

Status check_size(const sensor::ImageRgb8& picture, const geometry::CameraModel& model) {
  if (picture.width_px == model.width_px && picture.height_px == model.height_px) return {};
  return fail(Errc::kInvalidArgument, "the camera's picture is " + std::to_string(picture.width_px) + "x" +
                                          std::to_string(picture.height_px) + " but the rig says " +
                                          std::to_string(model.width_px) + "x" +
                                          std::to_string(model.height_px) +
                                          ": correct camera.width_px and height_px in rig.toml");
}

}  // namespace

KeyframeBuilder::KeyframeBuilder(const KeyframeConfig& config, const sensor::Rig& rig)
    : config_(config), rig_(rig) {
  if (rig_.camera) colouriser_.emplace(config_, *rig_.camera);
}

bool KeyframeBuilder::is_due(const tracking::TrackedGroup& group) const {
  if (!last_odom_from_body_) return true;
  if (group.stamp - last_stamp_ < from_seconds(config_.min_interval_s)) return false;
  const double moved_m = (group.odom_from_body.translation_m - last_odom_from_body_->translation_m).norm();
  const double turned_rad = group.odom_from_body.rotation.angularDistance(last_odom_from_body_->rotation);
  return moved_m >= config_.translation_m || turned_rad >= config_.rotation_rad;
}

std::vector<map::ColouredPoint> KeyframeBuilder::collect_points(const tracking::TrackedGroup& group) {
  std::vector<map::ColouredPoint> points;
  if (!colouriser_) {
    points = grey_points(group);
  } else {
    const geometry::RigidTransform body_from_odom = group.odom_from_body.inverse();
    const Eigen::Matrix3f rotation = body_from_odom.rotation.toRotationMatrix().cast<float>();
    const Eigen::Vector3f translation = body_from_odom.translation_m.cast<float>();
    for (const OdomPoint& p : colouriser_->take_coloured()) {
      points.push_back({rotation * p.p_in_odom_m + translation, p.rgb, true});
    }
  }
  return thin_points(std::move(points), static_cast<float>(config_.point_spacing_m));
}

Result<sensor::ImageRgb8> KeyframeBuilder::equalised(const sync::GroupImage& image) {
  if (rig_.camera) EDGESPLAT_TRY_STATUS(check_size(*image.image, rig_.camera->model));
  return exposure_.equalise(*image.image, image.exposure_s);
}

Result<std::shared_ptr<map::Keyframe>> KeyframeBuilder::begin_keyframe(
    const tracking::TrackedGroup& group, const sync::GroupImage* image,
    const sensor::ImageRgb8& picture) const {
  auto keyframe = std::make_shared<map::Keyframe>();
  if (image != nullptr) {
    auto encoded = std::make_shared<map::EncodedImage>();
    EDGESPLAT_TRY(encoded->bytes, io::encode_jpeg(picture, config_.jpeg_quality));
    encoded->width_px = picture.width_px;
    encoded->height_px = picture.height_px;
    keyframe->image = std::move(encoded);
    keyframe->exposure_s = image->exposure_s > 0.0F ? exposure_.reference_s() : 0.0F;
  }
  keyframe->stamp = group.stamp;
  keyframe->odom_from_body = group.odom_from_body;
  keyframe->pose_covariance = group.pose_covariance;
  keyframe->camera = rig_.camera;
  return keyframe;
}

Result<std::shared_ptr<const map::Keyframe>> KeyframeBuilder::add(
    const tracking::TrackedGroup& group, const std::optional<sync::GroupImage>& image) {
  if (group.health.state == tracking::TrackingState::kInitialising) return nullptr;
  sensor::ImageRgb8 picture;
  if (image) {
    EDGESPLAT_TRY(picture, equalised(*image));
  }
  if (colouriser_) {
    colouriser_->add_points(group);
    if (image) colouriser_->add_image(group, picture);
  }
  // A coasting pose is a guess: nothing is built on it.
  if (group.health.state != tracking::TrackingState::kTracking) return nullptr;
  if ((rig_.camera && !image) || !is_due(group)) return nullptr;

  EDGESPLAT_TRY(std::shared_ptr<map::Keyframe> keyframe,
                begin_keyframe(group, image ? &*image : nullptr, picture));
  keyframe->id = {next_id_++};
  keyframe->points_in_body = collect_points(group);
  last_odom_from_body_ = group.odom_from_body;
  last_stamp_ = group.stamp;
  return std::shared_ptr<const map::Keyframe>(std::move(keyframe));
}

Result<std::shared_ptr<const map::Keyframe>> KeyframeBuilder::hold_out(const tracking::TrackedGroup& group,
                                                                       const sync::GroupImage& image) {
  EDGESPLAT_TRY(const auto none, add(group, std::nullopt));
  (void)none;  // with a camera, a moment without a picture is no keyframe
  if (!rig_.camera || group.health.state != tracking::TrackingState::kTracking) return nullptr;
  EDGESPLAT_TRY(const sensor::ImageRgb8 picture, equalised(image));
  EDGESPLAT_TRY(std::shared_ptr<map::Keyframe> held_out, begin_keyframe(group, &image, picture));
  return std::shared_ptr<const map::Keyframe>(std::move(held_out));
}

}  // namespace edgesplat::keyframe
