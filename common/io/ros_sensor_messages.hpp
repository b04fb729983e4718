// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/io/bag_source.hpp"
#include "common/time/time.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

/// The messages of sensors in ROS recordings, of ROS 1 and 2 alike. Texts and bytes are borrowed from the
/// payload.
namespace edgesplat::io {

struct RosHeader {
  SensorTime stamp{};
  std::string_view frame_id;
};

/// sensor_msgs/Imu without its orientation and covariances.
struct RosImu {
  RosHeader header;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();     ///< rad/s
  Eigen::Vector3d linear_acceleration = Eigen::Vector3d::Zero();  ///< m/s^2; Livox's drivers write g
};

/// sensor_msgs/Image
struct RosImage {
  RosHeader header;
  std::uint32_t height_px = 0;
  std::uint32_t width_px = 0;
  std::string_view encoding;  ///< "mono8", "bgr8", ...
  std::uint32_t step_bytes = 0;
  std::span<const std::byte> data;
};

/// sensor_msgs/CompressedImage
struct RosCompressedImage {
  RosHeader header;
  std::string_view format;  ///< "jpeg", "bgr8; jpeg compressed bgr8"
  std::span<const std::byte> data;
};

/// sensor_msgs/PointField's numbers.
enum class RosFieldType : std::uint8_t {
  kInt8 = 1,
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kInt32 = 5,
  kUint32 = 6,
  kFloat32 = 7,
  kFloat64 = 8,
};
/// 0 for a number that is none of them.
[[nodiscard]] std::size_t bytes_of(RosFieldType type);

struct RosPointField {
  std::string_view name;
  std::uint32_t offset = 0;
  RosFieldType type = RosFieldType::kFloat32;
  std::uint32_t count = 1;
};

/// sensor_msgs/PointCloud2, little-endian; every point with every field lies in `data`. Without points it has
/// no rows either.
struct RosPointCloud {
  RosHeader header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::vector<RosPointField> fields;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::span<const std::byte> data;
};

/// livox_ros_driver/CustomMsg and livox_ros_driver2/CustomMsg
struct LivoxCustomPoint {
  std::uint32_t offset_ns = 0;  ///< after header.stamp
  Eigen::Vector3f p_m = Eigen::Vector3f::Zero();
  std::uint8_t reflectivity = 0;
  std::uint8_t tag = 0;
  std::uint8_t line = 0;
};
struct LivoxCustomMessage {
  RosHeader header;
  std::uint64_t timebase_ns = 0;
  std::vector<LivoxCustomPoint> points;
};

/// kCorrupt where the payload is too short for what it says, or holds what cannot be.
[[nodiscard]] Result<RosImu> decode_ros_imu(RosEncoding encoding, std::span<const std::byte> payload);
[[nodiscard]] Result<RosImage> decode_ros_image(RosEncoding encoding, std::span<const std::byte> payload);
[[nodiscard]] Result<RosCompressedImage> decode_ros_compressed_image(RosEncoding encoding,
                                                                     std::span<const std::byte> payload);
[[nodiscard]] Result<RosPointCloud> decode_ros_point_cloud(RosEncoding encoding,
                                                           std::span<const std::byte> payload);
[[nodiscard]] Result<LivoxCustomMessage> decode_livox_custom(RosEncoding encoding,
                                                             std::span<const std::byte> payload);

}  // namespace edgesplat::io
