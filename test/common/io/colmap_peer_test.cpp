// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/colmap_model.hpp"
#include "test/common/io/peer.hpp"
#include "test/support/temp_dir.hpp"

#include <map>
#include <set>
#include <sstream>

namespace edgesplat::io {
namespace {

/// COLMAP itself writes a camera of each model and says where each image shows each point: poses, models and
/// pixel centres are read right where we see them there, too.
void expect_peers_pixels(const std::string& form, double tolerance_px) {
  const test::TempDir folder;
  EDGESPLAT_PEER(lines, "colmap_write", folder / "sparse", form);
  const auto set = read_colmap(folder / "sparse", folder / "images");
  ASSERT_TRUE(set) << set.error().context;
  ASSERT_EQ(set->cameras.size(), 11U);
  std::map<std::string, const PosedCamera*> by_name;
  for (const PosedCamera& posed : set->cameras) by_name[posed.image.filename()] = &posed;
  ASSERT_EQ(lines.size(), 11U * 20U);
  std::set<std::string> models;
  for (const std::string& line : lines) {
    std::istringstream in(line);
    std::string name;
    Eigen::Vector3d point;
    Eigen::Vector2d pixel;
    in >> name >> point.x() >> point.y() >> point.z() >> pixel.x() >> pixel.y();
    ASSERT_TRUE(in) << line;
    const PosedCamera& posed = *by_name.at(name);
    const auto ours = posed.camera.project(posed.map_from_camera.inverse() * point);
    ASSERT_TRUE(ours) << line;
    EXPECT_LT((*ours + Eigen::Vector2d(0.5, 0.5) - pixel).norm(), tolerance_px) << line;
    models.insert(name);
  }
  EXPECT_EQ(models.size(), 11U);
  const auto cloud = read_points(set->points);
  ASSERT_TRUE(cloud) << cloud.error().context;
  EXPECT_EQ(cloud->points_m.size(), 20U);
}

TEST(ColmapPeer, SeesPointsWhereColmapSeesThemInBinaryFiles) {
  expect_peers_pixels("binary", 1e-6);
}
TEST(ColmapPeer, SeesPointsWhereColmapSeesThemInTextFiles) {
  expect_peers_pixels("text", 1e-6);
}

}  // namespace
}  // namespace edgesplat::io
