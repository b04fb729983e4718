// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/bag_rig.hpp"

#include "common/config/config_file.hpp"
#include "common/sensor/rig_config.hpp"

#include <utility>

namespace edgesplat::replay {
namespace {

using config::Range;

void describe_settings(config::ConfigReader& reader, BagSettings& c) {
  reader.field("lidar_topic", c.lidar_topic,
               "CustomMsg or PointCloud2; empty = the only one (of several, the only CustomMsg)");
  reader.field("imu_topic", c.imu_topic, "sensor_msgs/Imu; empty = the only one");
  reader.field("image_topic", c.image_topic, "Image or CompressedImage; empty = the only one");
  reader.choice(
      "clock", c.clock, {{"header", StampClock::kHeader}, {"arrival", StampClock::kArrival}},
      "header = the sensors' clocks agree, arrival = each has its own, fitted to the times of recording");
  reader.field("lidar_stamp_offset_s", c.lidar_stamp_offset_s, Range{-10.0, 10.0},
               "added to the points' stamps");
  reader.field("imu_stamp_offset_s", c.imu_stamp_offset_s, Range{-10.0, 10.0},
               "added to the IMU samples' stamps");
  reader.choice("imu_accel_unit", c.imu_accel_unit,
                {{"auto", AccelUnit::kAuto}, {"mps2", AccelUnit::kMps2}, {"g", AccelUnit::kG}},
                "auto = by the length of the first samples: Livox's drivers write g");
  reader.choice("point_time_unit", c.point_time_unit,
                {{"auto", PointTimeUnit::kAuto},
                 {"s", PointTimeUnit::kSeconds},
                 {"ms", PointTimeUnit::kMilliseconds},
                 {"us", PointTimeUnit::kMicroseconds},
                 {"ns", PointTimeUnit::kNanoseconds}},
                "of a PointCloud2; auto = whole numbers ns, others by the length of the first scan");
  reader.field("full_intensity", c.full_intensity, Range{1e-3, 1e6},
               "intensity of a PointCloud2 that is reflectivity 1");
}

}  // namespace

void describe(config::ConfigReader& reader, BagRig& rig) {
  sensor::describe(reader, rig.rig);
  reader.table("replay", "of ROS recordings", [&] { describe_settings(reader, rig.replay); });
}

Result<BagRig> parse_bag_rig(std::string_view text, std::string name) {
  EDGESPLAT_TRY(const config::ConfigFile file, config::ConfigFile::parse(text, std::move(name)));
  BagRig rig;
  EDGESPLAT_TRY_STATUS(file.read_into(rig));
  return rig;
}

Result<BagRig> load_bag_rig(const std::filesystem::path& path) {
  EDGESPLAT_TRY(const config::ConfigFile file, config::ConfigFile::load(path));
  BagRig rig;
  EDGESPLAT_TRY_STATUS(file.read_into(rig));
  return rig;
}

}  // namespace edgesplat::replay
