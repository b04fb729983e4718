// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/kitti_calib.hpp"

#include "test/robot/replay/kitti_text.hpp"

#include <gtest/gtest.h>

namespace edgesplat::replay {
namespace {

/// KITTI's own way: pixel = P * R_rect * Tr * p, all as 4x4 matrices.
Eigen::Vector2d project_by_the_book(const Eigen::Vector3d& p_in_lidar) {
  Eigen::Matrix<double, 3, 4> projection;
  projection << 721.5377, 0, 609.5593, 44.85728, 0, 721.5377, 172.854, 0.2163791, 0, 0, 1, 0.002745884;
  Eigen::Matrix4d rect = Eigen::Matrix4d::Identity();
  rect.topLeftCorner<3, 3>() << 9.999239e-01, 9.837760e-03, -7.445048e-03, -9.869795e-03, 9.999421e-01,
      -4.278459e-03, 7.402527e-03, 4.351614e-03, 9.999631e-01;
  Eigen::Matrix4d extrinsic = Eigen::Matrix4d::Identity();
  extrinsic.topRows<3>() << 7.533745e-03, -9.999714e-01, -6.166020e-04, -4.069766e-03, 1.480249e-02,
      7.280733e-04, -9.998902e-01, -7.631618e-02, 9.998621e-01, 7.523790e-03, 1.480755e-02, -2.717806e-01;
  return (projection * rect * extrinsic * p_in_lidar.homogeneous()).hnormalized();
}

TEST(KittiCalib, ProjectsAsTheBookSays) {
  const auto mount = parse_kitti_camera(kKittiCalib, "calib.txt", 1242, 375);
  ASSERT_TRUE(mount.has_value()) << mount.error().context;
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(5, 0, -1), Eigen::Vector3d(10, 4, 0.5), Eigen::Vector3d(40, -12, 2)}) {
    const auto pixel = mount->model.project(mount->body_from_camera.inverse() * p);
    ASSERT_TRUE(pixel.has_value());
    EXPECT_LT((*pixel - project_by_the_book(p)).norm(), 1e-2)
        << p.transpose();  // the file's rotations are rounded
  }
  EXPECT_EQ(mount->model.width_px, 1242);
  EXPECT_NEAR(mount->body_from_camera.translation_m.x(), 0.27, 0.02);  // camera ahead of the LiDAR
}

TEST(KittiCalib, TheFourthColumnMovesTheCamera) {
  std::string without = kKittiCalib;
  without.replace(without.find("44.85728"), 8, "0.000000");
  const auto with_column = parse_kitti_camera(kKittiCalib, "calib.txt", 1242, 375);
  const auto without_column = parse_kitti_camera(without, "calib.txt", 1242, 375);
  ASSERT_TRUE(with_column && without_column);
  const double moved =
      (with_column->body_from_camera.translation_m - without_column->body_from_camera.translation_m).norm();
  EXPECT_NEAR(moved, 44.85728 / 721.5377, 1e-6);
}

TEST(KittiCalib, NamesTheBadLineAndTheMissingKey) {
  std::string bad = kKittiCalib;
  bad.replace(bad.find("9.837760e-03"), 12, "nan         ");
  const auto not_finite = parse_kitti_camera(bad, "calib.txt", 1242, 375);
  ASSERT_FALSE(not_finite.has_value());
  EXPECT_EQ(not_finite.error().code, Errc::kInvalidConfig);
  EXPECT_NE(not_finite.error().context.find("calib.txt:3: R_rect_00"), std::string::npos)
      << not_finite.error().context;
  const auto missing = parse_kitti_camera("P_rect_02: 1 0 1 0 0 1 1 0 0 0 1 0\n", "calib.txt", 1242, 375);
  EXPECT_NE(missing.error().context.find("R_rect_00 is missing"), std::string::npos);
  for (const char* row :
       {"P_rect_02: 1 2 3", "P_rect_02: 1 2 3 4 5 6 7 8 9 10 11 12 13", "P_rect_02:", "P_rect_02: x"})
    EXPECT_EQ(parse_kitti_camera(row, "c", 10, 10).error().code, Errc::kInvalidConfig) << row;
}

TEST(KittiCalib, RefusesWhatIsNoRotationOrNoCamera) {
  std::string scaled = kKittiCalib;
  scaled.replace(scaled.find("9.999239e-01"), 12, "1.999239e-01");
  EXPECT_EQ(parse_kitti_camera(scaled, "c", 1242, 375).error().code, Errc::kInvalidConfig);
  std::string mirrored = kKittiCalib;
  mirrored.replace(
      mirrored.find("R_rect_00: 9.999239e-01 9.837760e-03 -7.445048e-03 -9.869795e-03 9.999421e-01"), 77,
      "R_rect_00: -9.999239e-01 -9.83776e-03 7.445048e-03 -9.869795e-03 9.999421e-01");
  EXPECT_EQ(parse_kitti_camera(mirrored, "c", 1242, 375).error().code, Errc::kInvalidConfig);
  std::string huge = kKittiCalib;
  huge.replace(huge.find("-4.069766e-03"), 13, "-9.998902e301");  // found by fuzzing: sums became NaN
  EXPECT_EQ(parse_kitti_camera(huge, "c", 1242, 375).error().code, Errc::kInvalidConfig);
  std::string flat = kKittiCalib;
  flat.replace(flat.find("721.5377"), 8, "0.000000");
  EXPECT_EQ(parse_kitti_camera(flat, "c", 1242, 375).error().code, Errc::kInvalidConfig);
  EXPECT_EQ(parse_kitti_camera(kKittiCalib, "c", 0, 375).error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace edgesplat::replay
