// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/image_file.hpp"
#include "common/map/keyframe.hpp"
#include "kernels/splat/render.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace edgesplat::test {

inline constexpr std::array<std::uint8_t, 3> kWallInPicture = {180, 90, 30};

/// A camera that looks along the body's x axis.
[[nodiscard]] inline sensor::CameraMount forward_camera() {
  sensor::CameraMount mount;
  mount.model = {geometry::CameraKind::kPinhole, 64, 48, 50.0, 50.0, 31.5, 23.5, {}};
  Eigen::Matrix3d body_from_camera;
  body_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  mount.body_from_camera.rotation = Eigen::Quaterniond(body_from_camera);
  return mount;
}

/// Keyframe `id` before a wall 3 m ahead, 5 m wide, at `y_m` to the left of the origin. The LiDAR's points
/// are grey and the same for one seed, the picture is of one other colour.
[[nodiscard]] inline std::shared_ptr<const map::Keyframe> facing_wall(std::uint32_t id, double y_m = 0.0,
                                                                      std::size_t points = 3000,
                                                                      std::uint64_t seed = 1) {
  Random random(seed);
  auto keyframe = std::make_shared<map::Keyframe>();
  keyframe->id.value = id;
  keyframe->exposure_s = 0.004F;
  keyframe->odom_from_body.translation_m.y() = y_m;
  keyframe->camera = forward_camera();
  for (std::size_t i = 0; i < points; ++i) {
    map::ColouredPoint point;
    point.p_in_body_m =
        Eigen::Vector3d(3.0, random.uniform(-2.5, 2.5), random.uniform(-2.0, 2.0)).cast<float>();
    point.rgb = {128, 128, 128};
    point.has_colour = true;
    keyframe->points_in_body.push_back(point);
  }
  sensor::ImageRgb8 picture(64, 48);
  for (std::size_t i = 0; i < picture.values.size(); ++i) picture.values[i] = kWallInPicture[i % 3];
  auto encoded = std::make_shared<map::EncodedImage>();
  encoded->format = map::EncodedImage::Format::kPng;
  encoded->width_px = 64;
  encoded->height_px = 48;
  encoded->bytes = *io::encode_png(picture);
  keyframe->image = std::move(encoded);
  return keyframe;
}

/// Mean difference, 0..1, between the keyframe's picture and the cloud drawn from its pose.
[[nodiscard]] inline double picture_error(const gaussian::GaussianCloud& cloud,
                                          const map::Keyframe& keyframe) {
  const auto odom_from_camera = keyframe.odom_from_body * keyframe.camera->body_from_camera;
  const auto view = splat::View::from(keyframe.camera->model, odom_from_camera.inverse());
  std::vector<float> colour(3 * 64 * 48), depth_m(64 * 48), alpha(64 * 48);
  EXPECT_TRUE(
      splat::render(core::Backend::kCpu, splat::spans_of(cloud), *view, {}, {colour, depth_m, alpha}));
  double sum = 0.0;
  for (std::size_t i = 0; i < colour.size(); ++i)
    sum += std::abs(static_cast<double>(colour[i]) - kWallInPicture[i % 3] / 255.0);
  return sum / static_cast<double>(colour.size());
}

}  // namespace edgesplat::test
