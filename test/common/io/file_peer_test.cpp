// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/image_file.hpp"
#include "common/io/ply_gaussians.hpp"
#include "common/io/ply_points.hpp"
#include "test/common/io/peer.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

#include <numeric>

namespace edgesplat::io {
namespace {

using ::testing::ElementsAre;

TEST(PlyPeer, ItReadsOurPoints) {
  const test::TempDir folder;
  PointCloud cloud;
  cloud.points_m = {{1.0F, 2.0F, 3.5F}, {-1.0F, 0.0F, 0.25F}};
  cloud.rgb = {{1, 2, 3}, {255, 0, 128}};
  ASSERT_TRUE(write_points_ply(folder / "p.ply", cloud));
  EDGESPLAT_PEER(lines, "ply_read", folder / "p.ply");
  EXPECT_THAT(lines, ElementsAre("x y z red green blue", "1 2 3.5 1 2 3", "-1 0 0.25 255 0 128"));
}

TEST(PlyPeer, ItReadsOurGaussians) {
  const test::TempDir folder;
  gaussian::GaussianCloud cloud;
  cloud.sh_degree = 1;
  cloud.resize(1);
  std::iota(cloud.means_m.begin(), cloud.means_m.end(), 1.0F);
  std::iota(cloud.log_scales.begin(), cloud.log_scales.end(), -9.0F);
  std::iota(cloud.sh.begin(), cloud.sh.end(), 100.0F);
  cloud.quats_xyzw = {0.5F, -0.5F, 0.5F, -0.5F};
  cloud.opacity_logits = {0.25F};
  ASSERT_TRUE(write_gaussians_ply(folder / "g.ply", cloud));
  EDGESPLAT_PEER(lines, "ply_read", folder / "g.ply");
  EXPECT_THAT(lines,
              ElementsAre("x y z nx ny nz f_dc_0 f_dc_1 f_dc_2 f_rest_0 f_rest_1 f_rest_2 f_rest_3 f_rest_4 "
                          "f_rest_5 f_rest_6 f_rest_7 f_rest_8 opacity scale_0 scale_1 scale_2 rot_0 rot_1 "
                          "rot_2 rot_3",
                          "1 2 3 0 0 0 100 101 102 103 106 109 104 107 110 105 108 111 0.25 -9 -8 -7 -0.5 "
                          "0.5 -0.5 0.5"));
}

TEST(PlyPeer, WeReadItsPoints) {
  const test::TempDir folder;
  for (const char* form : {"ascii", "binary"}) {
    EDGESPLAT_PEER(lines, "ply_write", folder / "p.ply", form);
    const auto cloud = read_points_ply(folder / "p.ply");
    ASSERT_TRUE(cloud) << cloud.error().context;
    ASSERT_EQ(cloud->points_m.size(), 3U);
    EXPECT_EQ(cloud->points_m[2], Eigen::Vector3f(2, -2, 1));
    EXPECT_THAT(cloud->rgb[2], ElementsAre(20, 40, 60));
  }
}

TEST(ImagePeer, ItReadsOurPictures) {
  const test::TempDir folder;
  sensor::ImageGray16 depth(2, 1);
  depth.values = {1000, 65535};
  sensor::ImageRgb8 colour(1, 2);
  colour.values = {1, 2, 3, 4, 5, 6};
  ASSERT_TRUE(save_image(folder / "depth.png", depth));
  ASSERT_TRUE(save_image(folder / "colour.png", colour));
  ASSERT_TRUE(save_image(folder / "grey.jpg", sensor::ImageGray8(2, 2, 77)));
  EDGESPLAT_PEER(depth_lines, "image_read", folder / "depth.png");
  EXPECT_THAT(depth_lines, ElementsAre("I;16 2 1 1000 65535"));
  EDGESPLAT_PEER(colour_lines, "image_read", folder / "colour.png");
  EXPECT_THAT(colour_lines, ElementsAre("RGB 1 2 1 2 3 4 5 6"));
  EDGESPLAT_PEER(grey_lines, "image_read", folder / "grey.jpg");
  EXPECT_THAT(grey_lines, ElementsAre("L 2 2 77 77 77 77"));
}

TEST(ImagePeer, WeReadItsPictures) {
  const test::TempDir folder;
  EDGESPLAT_PEER(grey, "image_write", folder / "l.png", "L");
  const auto luminance = load_image(folder / "l.png");
  ASSERT_TRUE(luminance);
  EXPECT_EQ(std::get<sensor::ImageGray8>(*luminance).pixel(4, 2)[0], 14);
  EDGESPLAT_PEER(deep, "image_write", folder / "i.png", "I;16");
  const auto depth = load_image(folder / "i.png");
  ASSERT_TRUE(depth);
  EXPECT_EQ(std::get<sensor::ImageGray16>(*depth).pixel(4, 2)[0], 14'000);
  for (const char* mode : {"RGB", "RGBA", "LA", "P"}) {
    EDGESPLAT_PEER(lines, "image_write", folder / "c.png", mode);
    const auto colour = load_rgb8(folder / "c.png");
    ASSERT_TRUE(colour) << mode << ": " << colour.error().context;
    std::string values;
    for (const int value : colour->values) values += (values.empty() ? "" : " ") + std::to_string(value);
    EXPECT_THAT(lines, ElementsAre(values)) << mode;
  }
}

}  // namespace
}  // namespace edgesplat::io
