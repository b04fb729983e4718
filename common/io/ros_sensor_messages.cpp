// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/ros_sensor_messages.hpp"

#include "common/io/ros_reader.hpp"

#include <string>

namespace edgesplat::io {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::size_t kCovarianceValues = 9;

tl::unexpected<Error> does_not_fit(std::string_view type, std::size_t payload_bytes) {
  return fail(Errc::kCorrupt,
              "a message of " + std::to_string(payload_bytes) + " bytes is no whole " + std::string(type));
}

RosHeader read_header(RosReader& reader) {
  const bool is_ros1 = reader.encoding() == RosEncoding::kRos1;
  if (is_ros1) (void)reader.read<std::uint32_t>();  // the sequence number
  const auto seconds_bits = reader.read<std::uint32_t>();
  const std::int64_t seconds =
      is_ros1 ? std::int64_t{seconds_bits} : std::int64_t{static_cast<std::int32_t>(seconds_bits)};
  const auto rest_ns = reader.read<std::uint32_t>();
  return {sensor_time_from_ns(seconds * kNsPerSecond + rest_ns), reader.read_text()};
}

Eigen::Vector3d read_vector(RosReader& reader) {
  const auto x = reader.read<double>();
  const auto y = reader.read<double>();
  return {x, y, reader.read<double>()};
}

RosPointField read_field(RosReader& reader) {
  RosPointField field;
  field.name = reader.read_text();
  field.offset = reader.read<std::uint32_t>();
  field.type = static_cast<RosFieldType>(reader.read<std::uint8_t>());
  field.count = reader.read<std::uint32_t>();
  return field;
}

LivoxCustomPoint read_livox_point(RosReader& reader) {
  LivoxCustomPoint point;
  point.offset_ns = reader.read<std::uint32_t>();
  for (int axis = 0; axis < 3; ++axis) point.p_m[axis] = reader.read<float>();
  point.reflectivity = reader.read<std::uint8_t>();
  point.tag = reader.read<std::uint8_t>();
  point.line = reader.read<std::uint8_t>();
  return point;
}

/// Every row, and in it every point with every field, within the data.
bool fits(const RosPointCloud& cloud) {
  for (const RosPointField& field : cloud.fields) {
    const std::uint64_t end = std::uint64_t{field.offset} + bytes_of(field.type);
    if (bytes_of(field.type) != 0 && end > cloud.point_step) return false;
  }
  if (cloud.height == 0 || cloud.width == 0) return true;
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  const std::uint64_t before_last = std::uint64_t{cloud.height - 1} * cloud.row_step;
  return cloud.point_step > 0 && row <= cloud.data.size() && before_last <= cloud.data.size() - row &&
         (cloud.height == 1 || cloud.row_step >= row);
}

}  // namespace

std::size_t bytes_of(RosFieldType type) {
  switch (type) {
    case RosFieldType::kInt8:
    case RosFieldType::kUint8:
      return 1;
    case RosFieldType::kInt16:
    case RosFieldType::kUint16:
      return 2;
    case RosFieldType::kInt32:
    case RosFieldType::kUint32:
    case RosFieldType::kFloat32:
      return 4;
    case RosFieldType::kFloat64:
      return 8;
  }
  return 0;
}

Result<RosImu> decode_ros_imu(RosEncoding encoding, std::span<const std::byte> payload) {
  RosReader reader(encoding, payload);
  RosImu imu;
  imu.header = read_header(reader);
  reader.skip<double>(4);  // orientation
  reader.skip<double>(kCovarianceValues);
  imu.angular_velocity = read_vector(reader);
  reader.skip<double>(kCovarianceValues);
  imu.linear_acceleration = read_vector(reader);
  if (!reader.ok() || !imu.angular_velocity.allFinite() || !imu.linear_acceleration.allFinite())
    return does_not_fit("sensor_msgs/Imu", payload.size());
  return imu;
}

Result<RosImage> decode_ros_image(RosEncoding encoding, std::span<const std::byte> payload) {
  RosReader reader(encoding, payload);
  RosImage image;
  image.header = read_header(reader);
  image.height_px = reader.read<std::uint32_t>();
  image.width_px = reader.read<std::uint32_t>();
  image.encoding = reader.read_text();
  (void)reader.read<std::uint8_t>();  // is_bigendian: of no matter for 8 bits a channel
  image.step_bytes = reader.read<std::uint32_t>();
  image.data = reader.read_bytes();
  if (!reader.ok()) return does_not_fit("sensor_msgs/Image", payload.size());
  return image;
}

Result<RosCompressedImage> decode_ros_compressed_image(RosEncoding encoding,
                                                       std::span<const std::byte> payload) {
  RosReader reader(encoding, payload);
  RosCompressedImage image;
  image.header = read_header(reader);
  image.format = reader.read_text();
  image.data = reader.read_bytes();
  if (!reader.ok()) return does_not_fit("sensor_msgs/CompressedImage", payload.size());
  return image;
}

Result<RosPointCloud> decode_ros_point_cloud(RosEncoding encoding, std::span<const std::byte> payload) {
  RosReader reader(encoding, payload);
  RosPointCloud cloud;
  cloud.header = read_header(reader);
  cloud.height = reader.read<std::uint32_t>();
  cloud.width = reader.read<std::uint32_t>();
  constexpr std::size_t kLeastFieldBytes = 13;
  const std::uint32_t fields = reader.read_count(kLeastFieldBytes);
  for (std::uint32_t i = 0; i < fields && reader.ok(); ++i) cloud.fields.push_back(read_field(reader));
  const auto is_big_endian = reader.read<std::uint8_t>();
  cloud.point_step = reader.read<std::uint32_t>();
  cloud.row_step = reader.read<std::uint32_t>();
  cloud.data = reader.read_bytes();
  if (!reader.ok() || is_big_endian != 0 || !fits(cloud))
    return does_not_fit("sensor_msgs/PointCloud2", payload.size());
  if (cloud.width == 0) cloud.height = 0;  // of rows without points there may be 4e9
  return cloud;
}

Result<LivoxCustomMessage> decode_livox_custom(RosEncoding encoding, std::span<const std::byte> payload) {
  RosReader reader(encoding, payload);
  LivoxCustomMessage message;
  message.header = read_header(reader);
  message.timebase_ns = reader.read<std::uint64_t>();
  (void)reader.read<std::uint32_t>();  // point_num: the list says it again
  reader.skip<std::uint8_t>(4);        // lidar_id and reserved
  constexpr std::size_t kPointBytes = 19;
  const std::uint32_t count = reader.read_count(kPointBytes);
  message.points.reserve(count);
  for (std::uint32_t i = 0; i < count && reader.ok(); ++i) message.points.push_back(read_livox_point(reader));
  if (!reader.ok()) return does_not_fit("CustomMsg", payload.size());
  return message;
}

}  // namespace edgesplat::io
