// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/image/undistort.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

void expect_pinholes_picture(const geometry::CameraModel& camera) {
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

TEST(Undistort, ShowsTheSceneAsThePinholeCameraSeesIt) {
  auto camera = distorted_camera();
  expect_pinholes_picture(camera);
  camera.k3 = -0.04;
  EXPECT_FALSE(undistorted_model(camera).has_distortion());
  expect_pinholes_picture(camera);
  camera.distortion = {};
  expect_pinholes_picture(camera);
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

TEST(Undistort, ShrunkPicturesShowTheSameFromTheSamePlace) {
  geometry::CameraModel camera = distorted_camera();
  camera.width_px = 161;  // a column is left over
  const Undistorter half(camera, 2);
  EXPECT_EQ(half.model().width_px, 80);
  EXPECT_EQ(half.model().height_px, 60);
  EXPECT_EQ(half.seen().size(), 80U * 60U);
  const auto got = half.apply(picture_of_directions(camera));
  const auto want = picture_of_directions(half.model());
  for (int y = 10; y < 50; ++y) {
    for (int x = 10; x < 70; ++x) {
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(got.pixel(x, y)[c], want.pixel(x, y)[c], 3) << x << "," << y;
    }
  }
}

TEST(Undistort, AShrunkPixelIsTheMeanOfItsPixels) {
  const auto camera = undistorted_model(distorted_camera());
  sensor::ImageRgb8 picture(camera.width_px, camera.height_px);
  picture.pixel(6, 3)[1] = 90;  // in the pixel (2, 1) of a third
  picture.pixel(8, 5)[1] = 180;
  const auto third = Undistorter(camera, 3).apply(picture);
  EXPECT_EQ(third.pixel(2, 1)[1], 30);
  EXPECT_EQ(third.pixel(1, 1)[1], 0);
  EXPECT_EQ(third.pixel(2, 1)[0], 0);
}

TEST(Undistort, AShrunkPixelWasSeenWhereAllOfItWas) {
  auto camera = distorted_camera();
  camera.distortion[0] = 0.3;  // the edges of the pinhole's picture lie outside this camera's
  const Undistorter full(camera), half(camera, 2);
  int unseen = 0;
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 80; ++x) {
      float least = 1.0F;
      for (int v = 2 * y; v < 2 * y + 2; ++v)
        for (int u = 2 * x; u < 2 * x + 2; ++u)
          least = std::min(least, full.seen()[static_cast<std::size_t>(v * 160 + u)]);
      EXPECT_EQ(half.seen()[static_cast<std::size_t>(y * 80 + x)], least);
      unseen += least == 0.0F ? 1 : 0;
    }
  }
  EXPECT_GT(unseen, 0);
}

}  // namespace
}  // namespace edgesplat::image
