// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/config/robot_config.hpp"

#include "common/config/config_reader.hpp"

namespace edgesplat::robot_config {
namespace {

using config::ConfigReader;
using config::Range;

void describe_livox(ConfigReader& reader, LivoxPorts& c) {
  reader.field("bind_address", c.bind_address, "address of the interface the LiDAR is on; 0.0.0.0 = all");
  reader.field("points_port", c.points_port, {1, 65535}, "UDP port the points arrive at");
  reader.field("imu_port", c.imu_port, {1, 65535}, "UDP port the IMU samples arrive at");
}

void describe_camera(ConfigReader& reader, CameraSocket& c) {
  reader.field("host", c.host, "address of the camera");
  reader.field("port", c.port, {1, 65535}, "TCP port of the camera");
}

void describe_sync(ConfigReader& reader, sync::GroupBuilderConfig& c) {
  reader.field("period_s", c.period_s, Range{0.01, 1.0}, "cut this often where no image tells when");
  reader.field("image_gap_s", c.image_gap_s, Range{0.05, 5.0},
               "images further apart: periodic cuts in between");
  reader.field("image_wait_s", c.image_wait_s, Range{0.0, 1.0}, "how far an image may lag behind the points");
  reader.field("sensor_gap_s", c.sensor_gap_s, Range{0.05, 5.0},
               "LiDAR or IMU silent this long: go on without");
  reader.field("image_tolerance_s", c.image_tolerance_s, Range{0.0, 0.1},
               "between a whole scan and its image");
}

void describe_uplink(ConfigReader& reader, uplink::UplinkConfig& c) {
  reader.field("robot", c.robot.value, {1, 65535}, "this robot's number; deltas for others are refused");
  reader.field("queue_keyframes", c.queue_keyframes, {1, 1024}, "waiting keyframes, oldest dropped first");
  reader.field("heartbeat_period_s", c.heartbeat_period_s, Range{0.05, 10.0}, "to the server");
}

void describe_map(ConfigReader& reader, map::ResidentMapConfig& c) {
  reader.field("budget_bytes", c.budget_bytes, {1 << 20, std::size_t{1} << 40U},
               "memory of resident Gaussians");
  reader.field("max_held_deltas", c.max_held_deltas, {1, 4096}, "deltas that wait for one before them");
  reader.field("publish_period_s", c.publish_period_s, Range{0.0, 10.0}, "least time between two snapshots");
}

void describe_server(ConfigReader& reader, ServerLink& c) {
  reader.field("enabled", c.enabled, "share the map with a server");
  reader.field("drain_s", c.drain_s, Range{0.0, 60.0}, "at the end, wait this long for the server's answers");
  reader.table("link", "the network to the server", [&] { describe(reader, c.link); });
}

}  // namespace

void describe(ConfigReader& reader, RobotConfig& c) {
  reader.table("livox", "the LiDAR", [&] { describe_livox(reader, c.livox); });
  reader.table("camera", "the camera", [&] { describe_camera(reader, c.camera); });
  reader.table("sync", "measurements to groups", [&] { describe_sync(reader, c.sync); });
  reader.table("tracking", "groups to poses", [&] { describe(reader, c.tracking); });
  reader.table("keyframe", "poses and pictures to keyframes", [&] { describe(reader, c.keyframe); });
  reader.table("uplink", "keyframes to the server", [&] { describe_uplink(reader, c.uplink); });
  reader.table("map", "the resident map", [&] { describe_map(reader, c.map); });
  reader.table("render", "the live picture", [&] {
    reader.field("target_hz", c.render.target_hz, Range{0.0, 120.0}, "pictures a second at most, 0 = never");
  });
  reader.table("server", "the edge server", [&] { describe_server(reader, c.server); });
}

}  // namespace edgesplat::robot_config
