// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/sensor/image_values.hpp"
#include "kernels/splat/render.hpp"
#include "robot/tracking/gaussian_view.hpp"
#include "test/robot/tracking/painted_room.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

namespace edgesplat::test {

/// A room painted as `brightness` says (grey levels), made of flat Gaussians that overlap, one each 6 cm.
[[nodiscard]] inline gaussian::GaussianCloud gaussian_room(
    const std::function<double(const Eigen::Vector3d&)>& brightness) {
  constexpr double kSpacing_m = 0.06;
  const std::array<double, 3> half_m{5.0, 4.0, 1.5};
  gaussian::GaussianCloud cloud;
  const auto add = [&](const Eigen::Vector3d& p, int across) {
    cloud.ids.emplace_back();
    cloud.anchors.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      cloud.means_m.push_back(static_cast<float>(p(axis)));
      cloud.log_scales.push_back(std::log(axis == across ? 0.003F : 0.9F * static_cast<float>(kSpacing_m)));
    }
    for (const float q : {0.0F, 0.0F, 0.0F, 1.0F}) cloud.quats_xyzw.push_back(q);
    cloud.opacity_logits.push_back(1.5F);
    const auto value = static_cast<float>(brightness(p) / 255.0);
    for (int c = 0; c < 3; ++c) cloud.sh.push_back((value - 0.5F) / gaussian::GaussianCloud::kShC0);
  };
  for (int across = 0; across < 3; ++across) {
    const int u = (across + 1) % 3, v = (across + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      for (double a = -half_m[static_cast<std::size_t>(u)]; a <= half_m[static_cast<std::size_t>(u)];
           a += kSpacing_m) {
        for (double b = -half_m[static_cast<std::size_t>(v)]; b <= half_m[static_cast<std::size_t>(v)];
             b += kSpacing_m) {
          Eigen::Vector3d p;
          p(across) = side * half_m[static_cast<std::size_t>(across)];
          p(u) = a;
          p(v) = b;
          add(p, across);
        }
      }
    }
  }
  return cloud;
}

struct DrawnFloats {
  std::vector<float> colour, depth_sum_m, alpha;
};

[[nodiscard]] inline DrawnFloats draw_floats(const gaussian::GaussianCloud& cloud,
                                             const geometry::CameraModel& camera,
                                             const geometry::RigidTransform& odom_from_camera) {
  const auto pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  DrawnFloats drawn{std::vector<float>(3 * pixels), std::vector<float>(pixels), std::vector<float>(pixels)};
  const auto view = splat::View::from(camera, odom_from_camera.inverse());
  EXPECT_TRUE(splat::render(core::Backend::kCpu, splat::spans_of(cloud), *view, {},
                            {drawn.colour, drawn.depth_sum_m, drawn.alpha}));
  return drawn;
}

/// What a camera with distortion would photograph of a cloud: a picture without, as wide, resampled (drawn
/// wider, the splats are other sizes against the pixels, and hide each other otherwise at grazing angles).
/// `gain` brightens as a longer exposure would: on the values plus 14.
[[nodiscard]] inline sensor::ImageRgb8 photograph(const gaussian::GaussianCloud& cloud,
                                                  const geometry::CameraModel& camera,
                                                  const geometry::RigidTransform& odom_from_camera,
                                                  double gain = 1.0) {
  constexpr int kBorder_px = 40;
  geometry::CameraModel wide = camera;
  wide.distortion = {};
  wide.width_px += 2 * kBorder_px;
  wide.height_px += 2 * kBorder_px;
  wide.cx_px += kBorder_px;
  wide.cy_px += kBorder_px;
  const DrawnFloats drawn = draw_floats(cloud, wide, odom_from_camera);
  sensor::ImageRgb8 photo(camera.width_px, camera.height_px);
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const auto at = *wide.project(camera.unproject(Eigen::Vector2d(x, y)));
      const double left = std::clamp(std::floor(at.x()), 0.0, wide.width_px - 2.0);
      const double top = std::clamp(std::floor(at.y()), 0.0, wide.height_px - 2.0);
      const auto value = [&](int right, int down) {
        const auto row = static_cast<std::size_t>(top) + static_cast<std::size_t>(down);
        const auto column = static_cast<std::size_t>(left) + static_cast<std::size_t>(right);
        return static_cast<double>(
            drawn.colour[3 * (row * static_cast<std::size_t>(wide.width_px) + column)]);
      };
      const double u = at.x() - left, v = at.y() - top;
      const double light =
          (1 - v) * ((1 - u) * value(0, 0) + u * value(1, 0)) + v * ((1 - u) * value(0, 1) + u * value(1, 1));
      const double grey = gain * (255.0 * light + 14.0) - 14.0;
      std::fill_n(photo.pixel(x, y), 3, static_cast<std::uint8_t>(std::clamp(grey + 0.5, 0.0, 255.0)));
    }
  }
  return photo;
}

/// Draws a cloud whenever it is asked.
class CloudView : public tracking::GaussianView {
 public:
  explicit CloudView(gaussian::GaussianCloud cloud) : cloud_(std::move(cloud)) {}

  [[nodiscard]] std::optional<tracking::GaussianPicture> draw(
      const geometry::CameraModel& camera, const geometry::RigidTransform& odom_from_camera) override {
    ++drawings;
    const DrawnFloats drawn = draw_floats(cloud_, camera, odom_from_camera);
    tracking::GaussianPicture picture{sensor::to_rgb8(drawn.colour, camera.width_px, camera.height_px),
                                      sensor::ImageF32(camera.width_px, camera.height_px),
                                      sensor::ImageF32(camera.width_px, camera.height_px)};
    picture.alpha.values = drawn.alpha;
    for (std::size_t i = 0; i < drawn.alpha.size(); ++i)
      picture.depth_m.values[i] = drawn.alpha[i] > 0.1F ? drawn.depth_sum_m[i] / drawn.alpha[i] : 0.0F;
    return picture;
  }
  [[nodiscard]] const gaussian::GaussianCloud& cloud() const { return cloud_; }
  int drawings = 0;

 private:
  gaussian::GaussianCloud cloud_;
};

}  // namespace edgesplat::test
