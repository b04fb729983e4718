// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/sensor/rig_config.hpp"

#include "common/config/config_file.hpp"

#include <array>
#include <cmath>

namespace edgesplat::sensor {
namespace {

using config::Range;

void describe_transform(config::ConfigReader& reader, geometry::RigidTransform& b_from_a) {
  constexpr double kFarthest_m = 1000.0;
  constexpr double kUnitTolerance = 1e-3;  // hand-written quaternions are rounded; more is a slip
  auto& t = b_from_a.translation_m;
  reader.fixed("translation_m", std::span(t.data(), 3), Range{-kFarthest_m, kFarthest_m}, "x, y, z");
  const Eigen::Quaterniond& q = b_from_a.rotation;
  std::array<double, 4> xyzw{q.x(), q.y(), q.z(), q.w()};
  reader.fixed("quaternion_xyzw", xyzw, Range{-1.0, 1.0}, "unit quaternion x, y, z, w");
  const Eigen::Quaterniond read(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  if (std::abs(read.norm() - 1.0) > kUnitTolerance) {
    reader.problem("quaternion_xyzw", "must have length 1 (order x, y, z, w)");
  } else if (read.coeffs() != q.coeffs()) {
    b_from_a.rotation = read.normalized();
  }
}

void describe_lidar(config::ConfigReader& reader, LidarMount& mount) {
  LidarModel& lidar = mount.model;
  reader.field("name", lidar.name, "model, for people");
  reader.field("range_sigma_m", lidar.range_sigma_m, Range{1e-4, 1.0}, "1 sigma along the ray");
  reader.field("bearing_sigma_rad", lidar.bearing_sigma_rad, Range{1e-6, 0.1}, "1 sigma across the ray");
  reader.field("min_range_m", lidar.min_range_m, Range{0.0, 100.0}, "nearer returns are dropped");
  reader.field("max_range_m", lidar.max_range_m, Range{1.0, 1000.0}, "farther returns are dropped");
  if (lidar.min_range_m >= lidar.max_range_m) reader.problem("min_range_m", "must be below max_range_m");
  reader.table("body_from_lidar", "where the LiDAR sits",
               [&] { describe_transform(reader, mount.body_from_lidar); });
}

void describe_lidars(config::ConfigReader& reader, Rig& rig) {
  std::vector<LidarMount> mounts;
  for (std::size_t unit = 0; unit < rig.lidar_count(); ++unit) mounts.push_back(rig.mount_of(unit));
  reader.tables(
      "lidar", mounts, kMostLidars, "noise and limits from the data sheet; the first one's IMU is the body",
      [](std::size_t) { return LidarMount{}; }, [&](LidarMount& mount) { describe_lidar(reader, mount); });
  rig.lidar = mounts.front().model;
  rig.body_from_lidar = mounts.front().body_from_lidar;
  rig.more_lidars.assign(mounts.begin() + 1, mounts.end());
}

void describe_imu(config::ConfigReader& reader, ImuModel& imu) {
  reader.field("rate_hz", imu.rate_hz, Range{10.0, 10000.0}, "samples a second");
  reader.field("gyro_noise_radps_per_sqrt_hz", imu.gyro_noise_radps_per_sqrt_hz, Range{1e-8, 1.0},
               "white noise");
  reader.field("accel_noise_mps2_per_sqrt_hz", imu.accel_noise_mps2_per_sqrt_hz, Range{1e-8, 10.0},
               "white noise");
  reader.field("gyro_bias_walk_radps2_per_sqrt_hz", imu.gyro_bias_walk_radps2_per_sqrt_hz, Range{1e-10, 1.0},
               "random walk of the bias");
  reader.field("accel_bias_walk_mps3_per_sqrt_hz", imu.accel_bias_walk_mps3_per_sqrt_hz, Range{1e-10, 10.0},
               "random walk of the bias");
}

void describe_camera(config::ConfigReader& reader, CameraMount& camera) {
  geometry::CameraModel& model = camera.model;
  reader.choice("model", model.kind,
                {{"pinhole", geometry::CameraKind::kPinhole}, {"fisheye", geometry::CameraKind::kFisheye}},
                "distortion k1 k2 p1 p2 (pinhole) or k1 k2 k3 k4 (fisheye), as OpenCV");
  reader.field("width_px", model.width_px, Range{1, 16384}, "");
  reader.field("height_px", model.height_px, Range{1, 16384}, "");
  reader.field("fx_px", model.fx_px, Range{1.0, 1e5}, "focal length");
  reader.field("fy_px", model.fy_px, Range{1.0, 1e5}, "focal length");
  reader.field("cx_px", model.cx_px, Range{-1e5, 1e5},
               "principal point; the top-left pixel's centre is 0, 0");
  reader.field("cy_px", model.cy_px, Range{-1e5, 1e5}, "principal point");
  reader.fixed("distortion", model.distortion, Range{-100.0, 100.0}, "zeros for an undistorted camera");
  reader.field("stamp_delay_s", camera.stamp_delay_s, Range{-1.0, 1.0},
               "added to a frame's stamp to get the middle of its exposure");
  reader.table("body_from_camera", "where the camera sits",
               [&] { describe_transform(reader, camera.body_from_camera); });
  // Without this a [camera] that forgets its size would be a camera of 0 x 0 pixels.
  if (const Status valid = model.validate(); !valid) reader.problem("width_px", valid.error().context);
}

}  // namespace

void describe(config::ConfigReader& reader, Rig& rig) {
  reader.field("name", rig.name, "of the robot or data set");
  describe_lidars(reader, rig);
  reader.optional_table("imu", rig.imu, "absent: no IMU, body = LiDAR frame",
                        [&](ImuModel& imu) { describe_imu(reader, imu); });
  reader.optional_table("camera", rig.camera, "absent: no camera",
                        [&](CameraMount& camera) { describe_camera(reader, camera); });
}

Result<Rig> parse_rig(std::string_view text, std::string name) {
  EDGESPLAT_TRY(const config::ConfigFile file, config::ConfigFile::parse(text, std::move(name)));
  Rig rig;
  EDGESPLAT_TRY_STATUS(file.read_into(rig));
  return rig;
}

Result<Rig> load_rig(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const config::ConfigFile file, config::ConfigFile::load(path));
  Rig rig;
  EDGESPLAT_TRY_STATUS(file.read_into(rig));
  return rig;
}

std::string print_rig(const Rig& rig) {
  return config::to_toml(rig);
}

}  // namespace edgesplat::sensor
