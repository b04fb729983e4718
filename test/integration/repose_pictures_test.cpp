// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// A finished map whose keyframes are put elsewhere looks the same from there, on both sides of the link.
#include "common/map/repose.hpp"
#include "robot/map/resident_map.hpp"
#include "server/stream/delta_stream.hpp"
#include "server/stream/map_uuid.hpp"
#include "test/integration/finished_map.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <string>

namespace edgesplat::map {
namespace {

using Poses = std::vector<geometry::RigidTransform>;

geometry::RigidTransform yaw(double rad) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitZ())), Eigen::Vector3d::Zero()};
}

/// The same way, bent a little at each keyframe; then all of it turned and moved, as finding north would.
Poses bent(const Poses& straight) {
  constexpr double kBend_rad = 0.001;  // 10 degrees in 100 m
  const geometry::RigidTransform north{yaw(1.1).rotation, {3.0, -2.0, 0.5}};
  Poses poses = {straight[0]};
  for (std::size_t i = 1; i < straight.size(); ++i)
    poses.push_back(poses.back() * (straight[i - 1].inverse() * straight[i]) * yaw(kBend_rad));
  for (auto& pose : poses) pose = north * pose;
  return poses;
}

std::vector<PoseCorrection> corrections(const Poses& from, const Poses& to) {
  std::vector<PoseCorrection> all;
  for (std::uint32_t i = 0; i < from.size(); ++i) all.push_back({i, 1, from[i], to[i]});
  return all;
}

stream::DeltaStreamConfig stream_config() {
  stream::DeltaStreamConfig config;
  config.robot.value = 1;
  config.map = stream::make_map_uuid();
  config.epoch.value = 1;
  return config;
}

class ReposePictures : public ::testing::TestWithParam<int> {
 protected:
  /// Bytes of the deltas that the robot took.
  std::size_t deliver(const std::vector<stream::Bytes>& deltas) {
    std::size_t bytes = 0;
    for (const auto& delta : deltas) {
      EXPECT_EQ(robot_.apply(delta, now_), ApplyOutcome::kApplied);
      bytes += delta.size();
    }
    return bytes;
  }
  std::size_t publish(const gaussian::GaussianCloud& cloud) {
    std::vector<std::uint32_t> rows(cloud.size());
    std::iota(rows.begin(), rows.end(), 0U);
    return deliver(stream_.publish(cloud, rows, {}, std::size_t{1} << 30U));
  }
  [[nodiscard]] gaussian::GaussianCloud robot_cloud() {
    robot_.publish_if_due(now_ += from_seconds(10.0));
    return *robot_.snapshot();
  }

  HostTime now_{};
  stream::DeltaStream stream_{stream_config()};
  ResidentMap robot_{ResidentMapConfig{}};
};

TEST_P(ReposePictures, AreTheSameFromTheBentWayOnBothSides) {
  auto finished = test::train_corridor(GetParam(), 160);
  gaussian::GaussianCloud& cloud = finished.cloud;
  const std::size_t map_bytes = publish(cloud);
  const double server_before_db = finished.psnr_db(cloud, finished.map_from_body);
  const double robot_before_db = finished.psnr_db(robot_cloud(), finished.map_from_body);

  const Poses poses = bent(finished.map_from_body);
  const auto moves = corrections(finished.map_from_body, poses);
  const std::size_t bytes = deliver(stream_.repose(moves));
  const Repose repose(moves);
  for (std::size_t row = 0; row < cloud.size(); ++row) EXPECT_TRUE(repose.move(cloud, row));

  EXPECT_EQ(robot_.map_hash(), stream_.position().map_hash);
  const double server_after_db = finished.psnr_db(cloud, poses);
  const double robot_after_db = finished.psnr_db(robot_cloud(), poses);
  EXPECT_GT(server_before_db, 20.0) << "a map that shows nothing loses nothing";
  EXPECT_NEAR(server_after_db, server_before_db, 0.5);
  EXPECT_NEAR(robot_after_db, robot_before_db, 0.5);
  const std::size_t bytes_each = bytes / poses.size();
  EXPECT_LE(bytes_each, 80U) << "a keyframe";

  // What the integers rounded away may be sent after, but not the map again.
  const std::size_t after_bytes = publish(cloud);
  EXPECT_LT(after_bytes, map_bytes / 5);
  EXPECT_EQ(robot_.map_hash(), stream_.position().map_hash);
  RecordProperty("server_db", std::to_string(server_before_db) + " -> " + std::to_string(server_after_db));
  RecordProperty("robot_db", std::to_string(robot_before_db) + " -> " + std::to_string(robot_after_db));
  RecordProperty("bytes_a_keyframe", std::to_string(bytes_each));
  RecordProperty("bytes_of_updates_after", std::to_string(after_bytes) + " of " + std::to_string(map_bytes));
  RecordProperty("gaussians", std::to_string(cloud.size()));
}

INSTANTIATE_TEST_SUITE_P(ShDegrees, ReposePictures, ::testing::Range(0, 4));

}  // namespace
}  // namespace edgesplat::map
