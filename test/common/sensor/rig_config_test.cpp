// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/sensor/rig_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace edgesplat::sensor {
namespace {

using testing::HasSubstr;

Rig full_rig() {
  Rig rig;
  rig.name = "bench";
  rig.lidar.name = "avia";
  rig.body_from_lidar = {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.1, -0.2, 0.3}};
  rig.imu = ImuModel{};
  rig.imu->rate_hz = 400.0;
  CameraMount camera;
  camera.model = {geometry::CameraKind::kFisheye, 640, 512, 300.5, 301.5, 319.5, 255.5,
                  {0.01, -0.02, 0.003, 0.0}};
  camera.body_from_camera = {Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), {0.05, 0.0, -0.1}};
  camera.stamp_delay_s = -0.004;
  rig.camera = camera;
  return rig;
}

TEST(RigConfig, PrintsAndReadsBack) {
  const Rig before = full_rig();
  const Result<Rig> after = parse_rig(print_rig(before), "rig.toml");
  ASSERT_TRUE(after) << after.error().context;
  EXPECT_EQ(after->name, "bench");
  EXPECT_EQ(after->lidar.name, "avia");
  EXPECT_EQ(after->body_from_lidar.translation_m, before.body_from_lidar.translation_m);
  EXPECT_EQ(after->body_from_lidar.rotation.coeffs(), before.body_from_lidar.rotation.coeffs());
  ASSERT_TRUE(after->imu && after->camera);
  EXPECT_EQ(after->imu->rate_hz, 400.0);
  EXPECT_EQ(after->camera->model.kind, geometry::CameraKind::kFisheye);
  EXPECT_EQ(after->camera->model.distortion, before.camera->model.distortion);
  EXPECT_EQ(after->camera->body_from_camera.rotation.coeffs(),
            before.camera->body_from_camera.rotation.coeffs());
  EXPECT_EQ(after->camera->stamp_delay_s, -0.004);
}

TEST(RigConfig, OneLidarIsATableAndSeveralAreAList) {
  Rig before = full_rig();
  EXPECT_THAT(print_rig(before), HasSubstr("\n[lidar]\n"));
  LidarMount second;
  second.model.name = "mid360";
  second.model.range_sigma_m = 0.03;
  second.body_from_lidar = {Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0), {-0.3, 0.1, 0.2}};
  before.more_lidars.push_back(second);
  EXPECT_THAT(print_rig(before), HasSubstr("\n[[lidar]]\n"));
  const Result<Rig> after = parse_rig(print_rig(before), "rig.toml");
  ASSERT_TRUE(after) << after.error().context;
  ASSERT_EQ(after->lidar_count(), 2U);
  EXPECT_EQ(after->lidar.name, "avia");
  EXPECT_EQ(after->mount_of(0).body_from_lidar.translation_m, before.body_from_lidar.translation_m);
  EXPECT_EQ(after->mount_of(1).model.name, "mid360");
  EXPECT_EQ(after->mount_of(1).model.range_sigma_m, 0.03);
  EXPECT_EQ(after->mount_of(1).body_from_lidar.translation_m, second.body_from_lidar.translation_m);
  EXPECT_EQ(after->mount_of(1).body_from_lidar.rotation.coeffs(), second.body_from_lidar.rotation.coeffs());
}

TEST(RigConfig, SaysWhichOfSeveralLidarsIsWrong) {
  const Result<Rig> crossed =
      parse_rig("[[lidar]]\n[[lidar]]\nmin_range_m = 50.0\nmax_range_m = 10.0", "r.toml");
  ASSERT_FALSE(crossed);
  EXPECT_THAT(crossed.error().context,
              HasSubstr("r.toml:3: lidar[1].min_range_m: must be below max_range_m"));
  std::string nine;
  for (int i = 0; i < 9; ++i) nine += "[[lidar]]\n";
  const Result<Rig> many = parse_rig(nine, "r.toml");
  ASSERT_FALSE(many);
  EXPECT_THAT(many.error().context, HasSubstr("lidar: are 9, must be 1 to 8"));
}

TEST(RigConfig, SensorsThatAreAbsentStayAbsent) {
  const Result<Rig> rig = parse_rig(print_rig(Rig{}), "rig.toml");
  ASSERT_TRUE(rig) << rig.error().context;
  EXPECT_FALSE(rig->imu.has_value());
  EXPECT_FALSE(rig->camera.has_value());
  EXPECT_TRUE(parse_rig("", "empty"));
}

TEST(RigConfig, NormalisesRoundedQuaternionsAndRefusesWrongOnes) {
  const Result<Rig> rounded =
      parse_rig("[lidar.body_from_lidar]\nquaternion_xyzw = [0, 0, 0.7071, 0.7071]", "r");
  ASSERT_TRUE(rounded) << rounded.error().context;
  EXPECT_NEAR(rounded->body_from_lidar.rotation.norm(), 1.0, 1e-15);
  const Result<Rig> wrong = parse_rig("\n[lidar.body_from_lidar]\nquaternion_xyzw = [0, 0, 1, 1]", "r.toml");
  ASSERT_FALSE(wrong);
  EXPECT_THAT(wrong.error().context,
              HasSubstr("r.toml:3: lidar.body_from_lidar.quaternion_xyzw: must have length 1"));
}

TEST(RigConfig, RefusesACameraWithoutASizeAndCrossedRanges) {
  const Result<Rig> no_size = parse_rig("[camera]\nfx_px = 300.0\nfy_px = 300.0", "r.toml");
  ASSERT_FALSE(no_size);
  EXPECT_THAT(no_size.error().context, HasSubstr("camera.width_px: camera model: size must be positive"));
  const Result<Rig> crossed = parse_rig("[lidar]\nmin_range_m = 50.0\nmax_range_m = 10.0", "r.toml");
  ASSERT_FALSE(crossed);
  EXPECT_THAT(crossed.error().context, HasSubstr("r.toml:2: lidar.min_range_m: must be below max_range_m"));
}

TEST(RigConfig, RefusesUnknownKeys) {
  const Result<Rig> rig = parse_rig("[imu]\nrate = 200", "r.toml");
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().code, Errc::kInvalidConfig);
  EXPECT_THAT(rig.error().context, HasSubstr("did you mean \"rate_hz\"?"));
}

}  // namespace
}  // namespace edgesplat::sensor
