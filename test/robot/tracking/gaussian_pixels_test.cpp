// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/tracking/gaussian_pixels.hpp"

#include "common/geometry/so3.hpp"
#include "kernels/train/blend_backward.hpp"
#include "kernels/train/gaussian_backward.hpp"
#include "test/robot/tracking/gaussian_room.hpp"

#include <gtest/gtest.h>

namespace edgesplat::tracking {
namespace {

using Eigen::Vector3d;
using geometry::RigidTransform;
using test::PaintedRoom;

/// A camera without distortion.
sensor::CameraMount pinhole() {
  sensor::CameraMount mount = PaintedRoom::camera();
  mount.model.distortion = {};
  return mount;
}

RigidTransform moved(const RigidTransform& body, const Vector6d& by) {
  return {body.rotation * geometry::so3_exp(by.head<3>()), body.translation_m + by.tail<3>()};
}

const RigidTransform kBody{geometry::so3_exp({0.05, -0.1, 0.4}), {-1.2, 0.7, 0.1}};

TEST(GaussianPixels, ValueByPoseEqualsCentralDifferences) {
  const sensor::CameraMount mount = pinhole();
  const DrawnFrom from{mount.model, kBody, mount.body_from_camera};
  test::Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3f p(static_cast<float>(random.uniform(-2.0, 2.0)),
                            static_cast<float>(random.uniform(-1.0, 1.0)),
                            static_cast<float>(random.uniform(1.0, 6.0)));
    const Eigen::Vector2f slope(static_cast<float>(random.uniform(-9.0, 9.0)),
                                static_cast<float>(random.uniform(-9.0, 9.0)));
    const Vector3d in_odom = kBody * mount.body_from_camera * p.cast<double>();
    // A picture whose values go with `slope`, seen from a pose.
    const auto value = [&](const Vector6d& by) {
      const auto pixel = mount.model.project((moved(kBody, by) * mount.body_from_camera).inverse() * in_odom);
      return slope.cast<double>().dot(*pixel);
    };
    const Eigen::Matrix<float, 6, 1> by_pose = value_by_pose(p, slope, from);
    constexpr double kStep = 1e-6;
    for (int k = 0; k < 6; ++k) {
      const Vector6d step = kStep * Vector6d::Unit(k);
      const double difference = (value(step) - value(-step)) / (2.0 * kStep);
      EXPECT_NEAR(static_cast<double>(by_pose(k)), difference, 1e-3 + 1e-4 * std::abs(difference)) << k;
    }
  }
}

// The gradient of the squared difference between a photo and the drawn map, once summed from the chosen
// pixels and once as the renderer's own reverse and its central differences have it.
TEST(GaussianPixels, GradientAgreesWithTheRenderersReverseAndWithDifferences) {
  const sensor::CameraMount mount = pinhole();
  const auto cloud = test::gaussian_room(PaintedRoom::brightness);
  const Vector6d off = (Vector6d() << 0.002, -0.003, 0.002, 0.01, -0.008, 0.009).finished();
  const RigidTransform camera = kBody * mount.body_from_camera;
  const test::DrawnFloats photo =
      test::draw_floats(cloud, mount.model, moved(kBody, off) * mount.body_from_camera);
  test::CloudView view(cloud);
  const auto drawn = view.draw(mount.model, camera);
  DepthCells depths;
  depths.build(PaintedRoom::scan(kBody, 3000), mount.body_from_camera.inverse(), mount.model);
  GaussianPixelChooser chooser;
  GaussianPixels pixels;
  chooser.choose(*drawn, {mount.model, kBody, mount.body_from_camera}, depths, {}, pixels);
  ASSERT_GT(pixels.levels[0].size(), 1000U);

  Vector6d summed = Vector6d::Zero();
  std::vector<std::size_t> chosen;
  for (const GaussianPixel& pixel : pixels.levels[0]) {
    const auto at = *mount.model.project(pixel.p_in_camera_m.cast<double>());
    const auto i =
        static_cast<std::size_t>(std::lround(at.y())) * static_cast<std::size_t>(mount.model.width_px) +
        static_cast<std::size_t>(std::lround(at.x()));
    chosen.push_back(i);
    const double residual =
        255.0 * static_cast<double>(photo.colour[3 * i]) - static_cast<double>(pixel.value);
    summed += residual * pixel.value_by_pose.cast<double>();
  }
  // Half the sum of squares over the chosen pixels, as drawn from a pose.
  const auto loss = [&](const Vector6d& by) {
    const auto at = test::draw_floats(cloud, mount.model, moved(kBody, by) * mount.body_from_camera);
    double sum = 0.0;
    for (const std::size_t i : chosen) {
      const double residual =
          255.0 * (static_cast<double>(photo.colour[3 * i]) - static_cast<double>(at.colour[3 * i]));
      sum += 0.5 * residual * residual;
    }
    return sum;
  };
  Vector6d difference;
  for (int k = 0; k < 6; ++k) {
    const double step = k < 3 ? 5e-4 : 2e-3;
    difference(k) = (loss(step * Vector6d::Unit(k)) - loss(-step * Vector6d::Unit(k))) / (2.0 * step);
  }
  // The renderer's reverse: by camera_from_odom, carried to the body's pose.
  const auto seen = *splat::View::from(mount.model, camera.inverse());
  const auto projected = *splat::project(core::Backend::kCpu, splat::spans_of(cloud), seen, {});
  const auto tiles = splat::make_tile_lists(projected.splats, seen.width_px, seen.height_px);
  const test::DrawnFloats here = test::draw_floats(cloud, mount.model, camera);
  std::vector<float> by_colour(here.colour.size(), 0.0F);
  for (const std::size_t i : chosen)
    by_colour[3 * i] = 255.0F * 255.0F * (here.colour[3 * i] - photo.colour[3 * i]);
  train::BlendBackwardScratch scratch;
  const auto by =
      train::blend_backward(projected.splats, tiles, seen, {here.colour, here.depth_sum_m, here.alpha},
                            {by_colour, {}, {}}, scratch);
  const auto by_camera = train::gaussian_backward(splat::spans_of(cloud), seen, {}, by.by_row).pose;
  const Eigen::Map<const Vector6d> g(by_camera.data());
  const Eigen::Matrix3d r_body = kBody.rotation.toRotationMatrix();
  const Eigen::Matrix3d r_camera = camera.inverse().rotation.toRotationMatrix();
  // camera_from_odom = camera_from_body (R'(p - t)): turns by -R dr, moves by R_c [t]x dr_c - R_c dt.
  const Vector3d by_turn =
      g.head<3>() + (r_camera * geometry::hat(kBody.translation_m)).transpose() * g.tail<3>();
  Vector6d reverse;
  reverse << -r_body.transpose() * by_turn, -r_camera.transpose() * g.tail<3>();

  const auto alike = [](const Vector6d& a, const Vector6d& b) { return a.dot(b) / (a.norm() * b.norm()); };
  for (const int part : {0, 3}) {
    const Vector3d s = summed.segment<3>(part), d = difference.segment<3>(part), r = reverse.segment<3>(part);
    EXPECT_LT((r - d).norm(), 0.05 * d.norm()) << part << ": " << r.transpose() << " / " << d.transpose();
    EXPECT_LT((s - d).norm(), 0.12 * d.norm()) << part << ": " << s.transpose() << " / " << d.transpose();
  }
  EXPECT_GT(alike(summed, reverse), 0.995);
}

TEST(GaussianPixels, EdgesHolesAndWhatTheScanDeniesAreLeftOut) {
  const sensor::CameraMount mount = pinhole();
  test::CloudView view(test::gaussian_room(PaintedRoom::brightness));
  auto drawn = *view.draw(mount.model, kBody * mount.body_from_camera);
  DepthCells depths;
  depths.build(PaintedRoom::scan(kBody, 20000), mount.body_from_camera.inverse(), mount.model);
  GaussianPixelChooser chooser;
  GaussianPixels pixels;
  chooser.choose(drawn, {mount.model, kBody, mount.body_from_camera}, depths, {}, pixels);
  EXPECT_GT(pixels.coverage, 0.95);
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 80; ++x) *drawn.alpha.pixel(x, y) = 0.5F;       // a hole
    for (int x = 160; x < 320; ++x) *drawn.depth_m.pixel(x, y) = 0.7F;  // nearer than the scan says
  }
  chooser.choose(drawn, {mount.model, kBody, mount.body_from_camera}, depths, PaintedRoom::scan(kBody, 20000),
                 pixels);
  EXPECT_NEAR(pixels.coverage, 0.75, 0.02);
  for (int level = 0; level < kGaussianLevels; ++level) {
    const geometry::CameraModel camera = image::halved(mount.model, level);
    const double size = std::ldexp(1.0, level);
    ASSERT_GT(pixels.levels[static_cast<std::size_t>(level)].size(), 30U) << level;
    std::size_t beyond = 0;
    for (const GaussianPixel& pixel : pixels.levels[static_cast<std::size_t>(level)]) {
      const auto at = *camera.project(pixel.p_in_camera_m.cast<double>());
      EXPECT_GT(at.x() * size, 80.0);
      if (at.x() * size > 160.0) ++beyond;
    }
    // Close to the picture's border there may be no point of the scan to speak against them.
    EXPECT_LT(beyond * 20, pixels.levels[static_cast<std::size_t>(level)].size()) << level;
  }
  ASSERT_GT(pixels.surface.size(), 100U);
  for (const SurfacePoint& point : pixels.surface) {
    EXPECT_NEAR(point.normal_in_odom.norm(), 1.0, 1e-4);
    if ((kBody * point.p_in_body_m.cast<double>() - point.on_surface_in_odom_m).norm() > 0.5) continue;
    const double off =
        point.normal_in_odom.dot(kBody * point.p_in_body_m.cast<double>() - point.on_surface_in_odom_m);
    EXPECT_LT(std::abs(off), 0.08);  // where a wall is seen at a grazing angle its expected depth is too near
  }
}

}  // namespace
}  // namespace edgesplat::tracking
