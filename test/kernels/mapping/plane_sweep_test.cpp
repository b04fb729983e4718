// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/plane_sweep.hpp"

#include "test/kernels/mapping/patterned_wall.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace edgesplat::mapping {
namespace {

using patterned_wall::camera, patterned_wall::seen_from, patterned_wall::kHeight_px, patterned_wall::kWall_m,
    patterned_wall::kWidth_px;

std::vector<float> empty_alpha() {
  return std::vector<float>(std::size_t{kWidth_px} * kHeight_px, 0.0F);
}

TEST(PlaneSweep, FindsAWallSideways) {
  const StoredView view = seen_from({0.0, 0.0, 0.0});
  const StoredView other = seen_from({0.5, 0.1, 0.0});
  const StoredView* const others[] = {&other};
  const auto depths = sweep_depths(view, others, nullptr, empty_alpha(), {});
  // All but the strip that the other does not see.
  ASSERT_GT(depths.size(), 800U);
  std::size_t near_wall = 0;
  for (const PixelDepth& d : depths)
    if (std::abs(1.0 / static_cast<double>(d.depth_m) - 1.0 / kWall_m) < 0.012) ++near_wall;
  EXPECT_GT(near_wall, depths.size() * 95 / 100) << "of " << depths.size();
}

TEST(PlaneSweep, FindsItDrivingTowardsIt) {
  const StoredView view = seen_from({0.0, 0.0, 1.0});
  const StoredView first = seen_from({0.0, 0.0, 0.5});
  const StoredView second = seen_from({0.0, 0.0, 0.0});
  const StoredView* const others[] = {&first, &second};
  const auto depths = sweep_depths(view, others, nullptr, empty_alpha(), {});
  ASSERT_GT(depths.size(), 800U);
  int near_wall = 0, aside = 0;
  for (const PixelDepth& d : depths) {
    // Straight ahead nothing moves in the picture: there it may be anywhere.
    if (std::hypot(d.x - camera().cx_px, d.y - camera().cy_px) < 20.0) continue;
    ++aside;
    if (std::abs(1.0 / static_cast<double>(d.depth_m) - 1.0 / (kWall_m - 1.0)) < 0.03) ++near_wall;
  }
  EXPECT_GT(near_wall, aside * 9 / 10) << "of " << aside;
}

TEST(PlaneSweep, PutsWhatShowsNoParallaxFarAway) {
  const StoredView view = seen_from({0.0, 0.0, 0.0}, 0.0);
  const StoredView other = seen_from({0.5, 0.0, 0.0}, 0.0);
  const StoredView* const others[] = {&other};
  int blank = 0;
  for (const PixelDepth& d : sweep_depths(view, others, nullptr, empty_alpha(), {})) {
    if (d.y > 36) continue;  // patches that touch the pattern
    ++blank;
    EXPECT_NEAR(d.depth_m, SweepOptions().farthest_m, 0.1F);
  }
  EXPECT_GT(blank, 200);
}

TEST(PlaneSweep, LeavesOutWhatNoDepthExplains) {
  const StoredView view = seen_from({0.0, 0.0, 0.0});
  StoredView other = seen_from({0.5, 0.0, 0.0});
  for (int y = 0; y < kHeight_px; ++y) {  // stripes that the new view does not show
    for (int x = 0; x < kWidth_px; ++x)
      for (int c = 0; c < 3; ++c) other.picture.pixel(x, y)[c] = x % 4 < 2 ? 0 : 255;
  }
  const StoredView* const others[] = {&other};
  EXPECT_TRUE(sweep_depths(view, others, nullptr, empty_alpha(), {}).empty());
}

TEST(PlaneSweep, AsksOnlyForWhatIsEmptySeenAndStill) {
  StoredView view = seen_from({0.0, 0.0, 0.0});
  const StoredView other = seen_from({0.3, 0.0, 0.0});
  const StoredView* const others[] = {&other};
  auto alpha = empty_alpha();
  for (int y = 0; y < kHeight_px; ++y) {
    for (int x = 0; x < kWidth_px / 2; ++x) alpha[static_cast<std::size_t>(y * kWidth_px + x)] = 0.9F;
  }
  view.ignored.resize(alpha.size(), false);
  for (std::size_t pixel = 0; pixel < alpha.size() / 2; ++pixel) view.ignored[pixel] = true;
  const auto depths = sweep_depths(view, others, nullptr, alpha, {});
  ASSERT_FALSE(depths.empty());
  for (const PixelDepth& d : depths) {
    EXPECT_GE(d.x, kWidth_px / 2);
    EXPECT_GE(d.y, kHeight_px / 2);
  }
  EXPECT_TRUE(sweep_depths(view, {}, nullptr, empty_alpha(), {}).empty()) << "nothing to compare with";
}

TEST(PlaneSweep, PutsNothingBeyondTheFloor) {
  const StoredView view = seen_from({0.0, 0.0, 0.0}, 1e9);  // all blank: as far as can be
  const StoredView other = seen_from({0.5, 0.0, 0.0}, 1e9);
  const StoredView* const others[] = {&other};
  GroundPlane floor;  // 1.2 m under the camera, whose y is down
  floor.normal = -Eigen::Vector3d::UnitY();
  floor.offset_m = -1.2;
  int on_floor = 0;
  for (const PixelDepth& d : sweep_depths(view, others, &floor, empty_alpha(), {})) {
    const double down = (d.y - camera().cy_px) / camera().fy_px;
    const double floor_m = down > 0.0 ? 1.2 / down : 1e9;
    if (floor_m > 100.0) {
      EXPECT_NEAR(d.depth_m, SweepOptions().farthest_m, 0.1F);
    } else {
      EXPECT_NEAR(d.depth_m, floor_m, 0.01 * floor_m);
      ++on_floor;
    }
  }
  EXPECT_GT(on_floor, 300);
}

TEST(PlaneSweep, FindsNothingInAPictureSmallerThanAPatch) {
  StoredView view;
  view.undistorter = std::make_shared<image::Undistorter>(
      geometry::CameraModel{geometry::CameraKind::kPinhole, 4, 40, 40.0, 40.0, 1.5, 19.5, {}});
  view.picture = sensor::ImageRgb8(4, 40, 90);
  StoredView other = view;
  other.map_from_camera.translation_m.x() = 0.5;
  const StoredView* const others[] = {&other};
  EXPECT_TRUE(sweep_depths(view, others, nullptr, std::vector<float>(160, 0.0F), {}).empty());
}

TEST(SweepPartners, LieFartherAndFartherApartAndLookTheSameWay) {
  const StoredView view = seen_from({0.0, 0.0, 2.0});
  StoredView turned = seen_from({0.0, 0.0, 1.0});
  turned.map_from_camera.rotation = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitY());
  const StoredView close = seen_from({0.0, 0.0, 1.9});
  const StoredView fair = seen_from({0.0, 0.0, 1.7});
  const StoredView fair_too = seen_from({0.0, 0.0, 1.6});
  const StoredView wide = seen_from({0.0, 0.0, 1.4});
  const StoredView* const newest_first[] = {&close, &turned, &fair, &fair_too, &wide};
  const auto partners = sweep_partners(view, newest_first, {});
  ASSERT_EQ(partners.size(), 2U);
  EXPECT_EQ(partners[0], &fair);
  EXPECT_EQ(partners[1], &wide);
}

}  // namespace
}  // namespace edgesplat::mapping
