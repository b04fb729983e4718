// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/desk/render_set.hpp"
#include "common/io/image_file.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::desk {
namespace {

/// One small red, opaque Gaussian.
gaussian::GaussianCloud make_dot(const Eigen::Vector3f& p_in_map) {
  gaussian::GaussianCloud cloud;
  cloud.resize(1);
  for (std::size_t i = 0; i < 3; ++i) {
    cloud.means_m[i] = p_in_map[static_cast<Eigen::Index>(i)];
    cloud.log_scales[i] = std::log(0.02F);
    cloud.sh[i] = (i == 0 ? 0.5F : -0.5F) / gaussian::GaussianCloud::kShC0;
  }
  cloud.quats_xyzw[3] = 1.0F;
  cloud.opacity_logits[0] = 6.0F;
  return cloud;
}

TEST(RenderSet, DrawsWhereTheCameraSays) {
  const test::TempDir folder;
  const auto file = folder.write("c.json", R"({"cameras": [
    {"name": "ahead", "width": 80, "height": 60, "fx": 50, "fy": 50, "cx": 40, "cy": 30,
     "map_from_camera": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]},
    {"name": "away", "width": 80, "height": 60, "fx": 50, "fy": 50, "cx": 40, "cy": 30,
     "map_from_camera": [[-1,0,0,0],[0,1,0,0],[0,0,-1,0]]}]})");
  const auto cameras = io::read_camera_set(file);
  ASSERT_TRUE(cameras) << cameras.error().context;
  RenderSettings settings;
  settings.background = {0.0F, 0.0F, 1.0F};
  const SteadyClock clock;
  const auto files =
      render_set(make_dot({0.4F, 0.2F, 2.0F}), *cameras, folder / "out" / "deep", settings, clock);
  ASSERT_TRUE(files) << files.error().context;
  ASSERT_EQ(files->size(), 2U);
  EXPECT_EQ((*files)[0].visible, 1U);
  EXPECT_EQ((*files)[1].visible, 0U);
  const auto ahead = io::load_rgb8(folder / "out" / "deep" / "ahead.png").value();
  EXPECT_GT(ahead.pixel(50, 35)[0], 240);  // 40 + 50 * 0.4 / 2, 30 + 50 * 0.2 / 2
  EXPECT_LT(ahead.pixel(50, 35)[2], 15);
  EXPECT_EQ(ahead.pixel(10, 10)[0], 0);
  EXPECT_EQ(ahead.pixel(10, 10)[2], 255);
  const auto away = io::load_rgb8(folder / "out" / "deep" / "away.png").value();
  EXPECT_EQ(away.pixel(50, 35)[0], 0);
}

TEST(RenderSet, ScalesAndLeavesDistortionOut) {
  io::PosedCamera camera;
  camera.camera = {geometry::CameraKind::kPinhole, 80, 60, 50, 50, 39.5, 29.5, {0.3, 0, 0, 0}};
  const SteadyClock clock;
  const auto view =
      render_view(make_dot({0.0F, 0.0F, 2.0F}), camera, {.scale = 0.5, .background = {}}, clock);
  ASSERT_TRUE(view) << view.error().context;
  EXPECT_EQ(view->picture.width_px, 40);
  EXPECT_EQ(view->picture.height_px, 30);
  EXPECT_GT(view->picture.pixel(19, 14)[0], 100);
}

}  // namespace
}  // namespace edgesplat::desk
