// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The robot's own reader against the simulator: neither shares code with the other.
#include "common/io/image_file.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/io/recording_topics.hpp"
#include "common/io/ros_messages.hpp"
#include "robot/drivers/replay/replay_source.hpp"
#include "tools/simulate/simulator.hpp"
#include "tools/simulate/trajectory.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

namespace edgesplat::simulate {
namespace {

struct Replayed {
  std::vector<sensor::ImuSample> imu;
  std::vector<sensor::LidarPacket> packets;
  std::vector<sensor::CameraFrame> frames;
  replay::ReplayReport report;
  sensor::Rig rig;
};

SimulateOptions three_seconds(const char* name) {
  SimulateOptions options;
  options.world.seed = 7;
  options.seconds = 3.0;
  options.camera_width_px = 64;
  options.camera_height_px = 48;
  options.out = std::filesystem::temp_directory_path() /
                ("simulate_replay_" + std::to_string(::getpid()) + "_" + name + ".mcap");
  return options;
}

Replayed simulate_and_replay(const SimulateOptions& options) {
  Replayed out;
  const auto simulated = simulate(options, {}, {});
  EXPECT_TRUE(simulated.has_value());
  auto source = replay::ReplaySource::open(options.out);
  EXPECT_TRUE(source.has_value()) << source.error().context;
  if (!source) return out;
  out.rig = source->rig();
  while (true) {
    auto measurement = source->next();
    if (!measurement || !*measurement) break;
    if (auto* imu = std::get_if<sensor::ImuSample>(&**measurement)) out.imu.push_back(*imu);
    if (auto* packet = std::get_if<sensor::LidarPacket>(&**measurement))
      out.packets.push_back(std::move(*packet));
    if (auto* frame = std::get_if<sensor::CameraFrame>(&**measurement))
      out.frames.push_back(std::move(*frame));
  }
  out.report = source->report();
  std::filesystem::remove(options.out);
  return out;
}

TEST(SimulatedRecording, RobotReadsAllOfIt) {
  const Replayed replayed = simulate_and_replay(three_seconds("all"));
  EXPECT_TRUE(replayed.report.complete) << replayed.report.why;
  EXPECT_EQ(replayed.report.packets_refused, 0U);
  EXPECT_EQ(replayed.report.frames_refused, 0U);
  EXPECT_EQ(replayed.imu.size(), 600U);
  EXPECT_EQ(replayed.packets.size(), 6250U);
  ASSERT_EQ(replayed.frames.size(), 30U);
  EXPECT_EQ(replayed.frames[3].sequence, 3U);
  EXPECT_EQ(replayed.frames[3].stamp_source, sensor::StampSource::kPtp);
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 250; ++k) force_mps2 += replayed.imu[k].accel_mps2 / 250.0;
  EXPECT_NEAR(force_mps2.norm(), 9.81, 0.15);  // bias and noise of the sensor
}

// Points put into the world with the true pose at the time of their ray lie on the world's surfaces: that
// holds only if stamps, packet spans, units, axes and the extrinsic all mean the same on both sides.
TEST(SimulatedRecording, PointsOfEachLidarLieOnTheWorldsSurfaces) {
  SimulateOptions options = three_seconds("surfaces");
  options.more_lidars = {LidarKind::kAvia};
  const Replayed replayed = simulate_and_replay(options);
  const auto world = World::create(options.world);
  ASSERT_TRUE(world.has_value());
  TrajectoryConfig config;
  config.duration_s = options.seconds;
  config.seed = options.world.seed;
  const auto trajectory = Trajectory::create((*world)->path(), config);
  ASSERT_TRUE(trajectory.has_value());
  int near = 0, all = 0;
  int packets[2] = {0, 0};
  for (std::size_t k = 11'000; k < replayed.packets.size(); k += 25) {  // the robot moves by then
    const sensor::LidarPacket& packet = replayed.packets[k];
    ++packets[packet.unit];
    for (const sensor::LidarPoint& point : packet.points) {
      const SensorTime fired = packet.stamp + nanoseconds(point.offset_ns);
      const double time_s = to_seconds(nanoseconds(to_ns(fired) - kEpoch_ns));
      const auto world_from_lidar =
          trajectory->world_from_body(time_s) * replayed.rig.mount_of(packet.unit).body_from_lidar;
      const Eigen::Vector3d in_lidar = point.p_in_lidar_m.cast<double>();
      const Ray ray{world_from_lidar.translation_m, world_from_lidar.rotation * in_lidar.normalized(),
                    time_s};
      const auto hit = (*world)->cast(ray, Visibility::kStaticOnly);
      if (hit && std::abs(hit->range_m - in_lidar.norm()) < 0.1) ++near;
      ++all;
    }
  }
  ASSERT_GT(all, 4000);
  EXPECT_GT(static_cast<double>(near), 0.95 * all);
  EXPECT_GT(packets[0], 20);
  EXPECT_GT(packets[1], 20);
}

// LiDAR and camera see one world: returns fired around an exposure land in its depth picture at their depth.
TEST(SimulatedRecording, PointsAgreeWithTheDepthPicture) {
  SimulateOptions options = three_seconds("depth");
  options.seconds = 0.3;  // standing still
  const auto simulated = simulate(options, {}, {});
  ASSERT_TRUE(simulated.has_value());
  auto reader = io::McapReader::open(options.out);
  ASSERT_TRUE(reader.has_value());
  reader->select({.topics = {std::string(io::kTruthCameraDepthTopic)}});
  const auto message = reader->next();
  ASSERT_TRUE(message.has_value());
  const auto picture = io::decode_compressed_image(message->payload);
  ASSERT_TRUE(picture.has_value());
  const auto depth_mm = io::decode_gray16(picture->encoded);
  ASSERT_TRUE(depth_mm.has_value());

  const Replayed replayed = simulate_and_replay(options);
  const sensor::CameraMount& camera = *replayed.rig.camera;
  const auto camera_from_lidar = camera.body_from_camera.inverse() * replayed.rig.body_from_lidar;
  int agree = 0, all = 0;
  for (const sensor::LidarPacket& packet : replayed.packets) {
    for (const sensor::LidarPoint& point : packet.points) {
      const Eigen::Vector3d p_in_camera =
          camera_from_lidar * Eigen::Vector3d(point.p_in_lidar_m.cast<double>());
      const auto pixel = camera.model.project(p_in_camera);
      if (!pixel || !camera.model.contains(*pixel)) continue;
      const auto x = static_cast<int>(std::lround(pixel->x())), y = static_cast<int>(std::lround(pixel->y()));
      const double depth_m = 1e-3 * *depth_mm->pixel(x, y);
      if (std::abs(depth_m - p_in_camera.z()) < 0.05 * p_in_camera.z()) ++agree;
      ++all;
    }
  }
  ASSERT_GT(all, 2000);
  EXPECT_GT(static_cast<double>(agree), 0.9 * all);
}

TEST(SimulatedRecording, FreeClocksCountFromPowerOn) {
  SimulateOptions options = three_seconds("free");
  options.clock = ClockMode::kFree;
  options.lidar = LidarKind::kAvia;
  options.seconds = 0.5;
  const Replayed replayed = simulate_and_replay(options);
  ASSERT_FALSE(replayed.packets.empty());
  EXPECT_EQ(replayed.packets.front().stamp_source, sensor::StampSource::kFreeRunning);
  EXPECT_LT(to_ns(replayed.packets.front().stamp), 200'000'000'000);
  ASSERT_FALSE(replayed.frames.empty());
  EXPECT_NE(to_ns(replayed.frames.front().stamp) / 1'000'000, to_ns(replayed.imu[10].stamp) / 1'000'000);
  EXPECT_EQ(replayed.rig.lidar.name, "avia");
}

TEST(SimulatedRecording, EachLidarHasAClockOfItsOwn) {
  SimulateOptions options = three_seconds("clocks");
  options.clock = ClockMode::kFree;
  options.more_lidars = {LidarKind::kMid360, LidarKind::kAvia};
  options.seconds = 0.5;
  const Replayed replayed = simulate_and_replay(options);
  ASSERT_EQ(replayed.rig.lidar_count(), 3U);
  EXPECT_EQ(replayed.rig.mount_of(2).model.name, "avia");
  SensorTime first[3]{};
  for (const sensor::LidarPacket& packet : replayed.packets)
    if (first[packet.unit] == SensorTime{}) first[packet.unit] = packet.stamp;
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}})
    EXPECT_GT(std::abs((first[a] - first[b]).count()), 1'000'000);
  const auto again = parse_world_toml(world_toml(options));
  ASSERT_TRUE(again.has_value()) << again.error().context;
  EXPECT_EQ(again->more_lidars, options.more_lidars);
}

}  // namespace
}  // namespace edgesplat::simulate
