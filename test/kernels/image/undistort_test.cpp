// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/undistort.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::image {
namespace {

geometry::CameraModel distorted_camera() {
  return {geometry::CameraKind::kPinhole, 160, 120, 120.0, 118.0, 80.0, 59.0, {-0.2, 0.05, 0.001, -0.002}};
}

/// A scene at infinity with a smooth colour for every direction, seen through any camera.
sensor::ImageRgb8 picture_of_directions(const geometry::CameraModel& camera) {
  sensor::ImageRgb8 image(camera.width_px, camera.height_px);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const Eigen::Vector3d ray = camera.unproject({x, y});
      for (int c = 0; c < 3; ++c) {
        image.pixel(x, y)[c] =
            static_cast<std::uint8_t>(std::lround(128 + 100 * std::sin(4 * ray[c % 2] + c)));
      }
    }
  }
  return image;
}

TEST(Undistort, ShowsTheSceneAsThePinholeCameraSeesIt) {
  const auto camera = distorted_camera();
  const auto got = Undistorter(camera).apply(picture_of_directions(camera));
  const auto want = picture_of_directions(undistorted_model(camera));
  int compared = 0;
  for (int y = 20; y < 100; ++y) {
    for (int x = 20; x < 140; ++x) {
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(got.pixel(x, y)[c], want.pixel(x, y)[c], 3) << x << "," << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
}

TEST(Undistort, LeavesAnUndistortedPictureAlone) {
  const auto camera = undistorted_model(distorted_camera());
  const auto image = picture_of_directions(camera);
  EXPECT_EQ(Undistorter(camera).apply(image).values, image.values);
}

TEST(Undistort, WhatTheCameraNeverSawIsBlack) {
  auto camera = distorted_camera();
  camera.distortion = {0.6, 0.0, 0.0, 0.0};  // pincushion: the pinhole's corners lie outside the picture
  sensor::ImageRgb8 white(camera.width_px, camera.height_px, 255);
  const auto got = Undistorter(camera).apply(white);
  EXPECT_EQ(got.pixel(0, 0)[0], 0);
  EXPECT_EQ(got.pixel(80, 60)[0], 255);
  const Undistorter undistorter(camera);
  EXPECT_EQ(undistorter.seen()[0], 0.0F);
  EXPECT_EQ(undistorter.seen()[60 * 160 + 80], 1.0F);
  for (std::size_t pixel = 0; pixel < undistorter.seen().size(); ++pixel) {
    EXPECT_EQ(got.values[3 * pixel] == 255, undistorter.seen()[pixel] == 1.0F) << pixel;
  }
}

}  // namespace
}  // namespace edgesplat::image
