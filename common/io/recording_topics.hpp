// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Topics and attachments of a recording (see ARCHITECTURE.md).
namespace edgesplat::io {

inline constexpr std::string_view kLidarPointsTopic = "/lidar/points_raw";
inline constexpr std::string_view kLidarImuTopic = "/lidar/imu_raw";
inline constexpr std::string_view kLidarControlTopic = "/lidar/control_raw";
inline constexpr std::string_view kCameraMetaTopic = "/camera/meta";
inline constexpr std::string_view kCameraImageTopic = "/camera/image";
inline constexpr std::string_view kTruthBodyPoseTopic = "/truth/body_pose";
inline constexpr std::string_view kTruthCameraCleanTopic = "/truth/camera_clean";
inline constexpr std::string_view kTruthCameraMaskTopic = "/truth/camera_mask";
inline constexpr std::string_view kTruthCameraDepthTopic = "/truth/camera_depth";

/// The same topic of a further LiDAR: unit 1 has /lidar1/points_raw, and so on; unit 0 has the names above.
[[nodiscard]] inline std::string topic_of_lidar(std::string_view topic, std::size_t unit) {
  constexpr std::string_view kPrefix = "/lidar";
  if (unit == 0 || !topic.starts_with(kPrefix)) return std::string(topic);
  return std::string(kPrefix) + std::to_string(unit) + std::string(topic.substr(kPrefix.size()));
}

/// Metadata of the /lidar channels: the wire protocol of their datagrams; without it SDK2.
inline constexpr std::string_view kProtocolKey = "protocol";
inline constexpr std::string_view kLivoxSdk1 = "livox_sdk1";
inline constexpr std::string_view kLivoxSdk2 = "livox_sdk2";

inline constexpr std::string_view kRigAttachment = "rig.toml";
inline constexpr std::string_view kWorldAttachment = "world.toml";
inline constexpr std::string_view kRobotConfigAttachment = "robot.toml";

}  // namespace edgesplat::io
