// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/seen_through.hpp"

#include <gtest/gtest.h>

namespace edgesplat::mapping {
namespace {

/// A camera at the map's origin that looks along z, and LiDAR depths of `depth_m` in every other pixel.
StoredView view_of_wall(std::uint32_t keyframe, float depth_m) {
  StoredView view;
  view.keyframe = map::KeyframeId{keyframe};
  view.undistorter = std::make_shared<image::Undistorter>(
      geometry::CameraModel{geometry::CameraKind::kPinhole, 64, 48, 50.0, 50.0, 31.5, 23.5, {}});
  view.picture = sensor::ImageRgb8(64, 48);
  for (std::uint32_t pixel = 0; pixel < 64 * 48; pixel += 2) view.depths.push_back({pixel, depth_m});
  return view;
}

gaussian::GaussianCloud gaussians_at(const std::vector<float>& depths_m, std::uint32_t anchor) {
  gaussian::GaussianCloud cloud;
  cloud.resize(depths_m.size());
  for (std::size_t i = 0; i < depths_m.size(); ++i) {
    cloud.ids[i] = gaussian::GaussianId(1, i + 1);
    cloud.means_m[3 * i + 2] = depths_m[i];
    cloud.anchors[i].keyframe = anchor;
  }
  return cloud;
}

TEST(SeenThrough, FindsWhatStandsInFrontOfWhatWasMeasured) {
  SeenThrough judge({});
  // In front, just in front (noise), at and behind the measured wall.
  const auto cloud = gaussians_at({2.0F, 3.9F, 4.0F, 6.0F}, 1);
  EXPECT_EQ(judge.take(view_of_wall(7, 4.0F), cloud), std::vector<std::uint32_t>{0});
}

TEST(SeenThrough, WaitsForAsManyViewsAsAsked) {
  SeenThroughOptions options;
  options.votes = 3;
  SeenThrough judge(options);
  const auto cloud = gaussians_at({2.0F}, 1);
  EXPECT_TRUE(judge.take(view_of_wall(7, 4.0F), cloud).empty());
  EXPECT_TRUE(judge.take(view_of_wall(8, 4.0F), cloud).empty());
  EXPECT_EQ(judge.suspects(), 1U);
  EXPECT_EQ(judge.take(view_of_wall(9, 4.0F), cloud).size(), 1U);
  EXPECT_EQ(judge.suspects(), 0U);
}

TEST(SeenThrough, ARayThatStopsAtItSavesIt) {
  SeenThrough judge({});
  StoredView view = view_of_wall(7, 4.0F);
  for (SparseDepth& d : view.depths) {
    if (d.pixel == 24 * 64 + 32) d.depth_m = 2.0F;
  }
  EXPECT_TRUE(judge.take(view, gaussians_at({2.0F}, 1)).empty());
}

TEST(SeenThrough, DoesNotJudgeByTheKeyframeThatMadeItNorWithoutRays) {
  SeenThrough judge({});
  EXPECT_TRUE(judge.take(view_of_wall(1, 4.0F), gaussians_at({2.0F}, 1)).empty());
  StoredView blind = view_of_wall(7, 4.0F);
  blind.depths.clear();
  EXPECT_TRUE(judge.take(blind, gaussians_at({2.0F}, 1)).empty());
}

}  // namespace
}  // namespace edgesplat::mapping
