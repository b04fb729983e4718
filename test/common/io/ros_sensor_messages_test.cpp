// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/ros_sensor_messages.hpp"

#include "test/common/io/ros_samples.hpp"

#include <gtest/gtest.h>

namespace edgesplat::io {
namespace {

constexpr std::int64_t kStamp_ns = 1'650'000'000'123'456'789;

class RosSensorMessages : public ::testing::TestWithParam<RosEncoding> {};
INSTANTIATE_TEST_SUITE_P(BothEncodings, RosSensorMessages,
                         ::testing::Values(RosEncoding::kRos1, RosEncoding::kCdr),
                         [](const auto& one) { return one.param == RosEncoding::kRos1 ? "Ros1" : "Cdr"; });

/// Every shorter payload is refused, and none of them is read beyond its end (the sanitizer build sees that).
template <typename Decode>
void expect_whole_or_nothing(const std::vector<std::byte>& whole, std::size_t needed, const Decode& decode) {
  for (std::size_t length = 0; length < needed; ++length) {
    const std::vector<std::byte> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_FALSE(decode(part)) << length << " of " << whole.size();
  }
  EXPECT_TRUE(decode(whole));
}

TEST_P(RosSensorMessages, Imu) {
  const auto bytes = imu_message(GetParam(), kStamp_ns, {0.1, -0.2, 0.3}, {1.0, 2.0, 9.8});
  const auto imu = decode_ros_imu(GetParam(), bytes);
  ASSERT_TRUE(imu) << imu.error().context;
  EXPECT_EQ(to_ns(imu->header.stamp), kStamp_ns);
  EXPECT_EQ(imu->header.frame_id, "imu_link");
  EXPECT_EQ(imu->angular_velocity, Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(imu->linear_acceleration, Eigen::Vector3d(1.0, 2.0, 9.8));
  expect_whole_or_nothing(bytes, bytes.size() - 9 * sizeof(double),
                          [](const auto& part) { return decode_ros_imu(GetParam(), part).has_value(); });
  const auto bad = imu_message(GetParam(), kStamp_ns, {std::nan(""), 0.0, 0.0}, {0.0, 0.0, 9.8});
  EXPECT_FALSE(decode_ros_imu(GetParam(), bad));
}

TEST_P(RosSensorMessages, LivoxCustom) {
  const auto bytes = livox_message(GetParam(), kStamp_ns,
                                   {{0, 1.0F, 2.0F, 3.0F, 9, 0x10, 4}, {4167, -1.5F, 0, 7.25F, 255, 0, 1}});
  const auto message = decode_livox_custom(GetParam(), bytes);
  ASSERT_TRUE(message) << message.error().context;
  EXPECT_EQ(to_ns(message->header.stamp), kStamp_ns);
  EXPECT_EQ(message->timebase_ns, static_cast<std::uint64_t>(kStamp_ns));
  ASSERT_EQ(message->points.size(), 2U);
  EXPECT_EQ(message->points[0].reflectivity, 9);
  EXPECT_EQ(message->points[0].tag, 0x10);
  EXPECT_EQ(message->points[0].line, 4);
  EXPECT_EQ(message->points[1].offset_ns, 4167U);
  EXPECT_EQ(message->points[1].p_m, Eigen::Vector3f(-1.5F, 0.0F, 7.25F));
  expect_whole_or_nothing(bytes, bytes.size(),
                          [](const auto& part) { return decode_livox_custom(GetParam(), part).has_value(); });
}

SampleCloud two_points() {
  ByteWriter data;
  for (const float x : {1.0F, 2.0F}) {
    for (const float value : {x, 0.5F, -0.5F}) data.write(value);
    data.write(std::uint32_t{77});
  }
  return {{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"t", 12, 6}}, 16, 2, 1, data.take()};
}

TEST_P(RosSensorMessages, PointCloud) {
  const auto bytes = cloud_message(GetParam(), kStamp_ns, two_points());
  const auto cloud = decode_ros_point_cloud(GetParam(), bytes);
  ASSERT_TRUE(cloud) << cloud.error().context;
  EXPECT_EQ(cloud->width, 2U);
  ASSERT_EQ(cloud->fields.size(), 4U);
  EXPECT_EQ(cloud->fields[3].name, "t");
  EXPECT_EQ(cloud->fields[3].type, RosFieldType::kUint32);
  EXPECT_EQ(cloud->data.size(), 32U);
  expect_whole_or_nothing(bytes, bytes.size() - 1, [](const auto& part) {
    return decode_ros_point_cloud(GetParam(), part).has_value();
  });
}

TEST_P(RosSensorMessages, PointCloudsWhosePointsAreNotThereAreRefused) {
  const auto decodes = [](const SampleCloud& cloud) {
    return decode_ros_point_cloud(GetParam(), cloud_message(GetParam(), kStamp_ns, cloud)).has_value();
  };
  SampleCloud cloud = two_points();
  cloud.width = 3;
  EXPECT_FALSE(decodes(cloud));
  cloud = two_points();
  cloud.height = 0xFFFF'FFFFU;
  EXPECT_FALSE(decodes(cloud));
  cloud = two_points();
  cloud.width = 0xFFFF'FFFFU;
  EXPECT_FALSE(decodes(cloud));
  cloud = two_points();
  cloud.fields[3].offset = 13;  // its last byte lies in the next point
  EXPECT_FALSE(decodes(cloud));
  cloud = two_points();
  cloud.fields[3].offset = 0xFFFF'FFFEU;
  EXPECT_FALSE(decodes(cloud));
  cloud = two_points();
  cloud.point_step = 0;
  EXPECT_FALSE(decodes(cloud));
  cloud = two_points();
  cloud.big_endian = true;
  EXPECT_FALSE(decodes(cloud));
}

TEST_P(RosSensorMessages, ACloudWithoutPointsHasNoRowsHoweverManyItSays) {
  SampleCloud cloud = two_points();
  cloud.width = 0;
  cloud.height = 0xFFFF'FFFFU;
  const auto decoded = decode_ros_point_cloud(GetParam(), cloud_message(GetParam(), kStamp_ns, cloud));
  ASSERT_TRUE(decoded.has_value()) << decoded.error().context;
  EXPECT_EQ(decoded->width, 0U);
  EXPECT_EQ(decoded->height, 0U) << "whoever walks through its rows would do so for seconds";
}

TEST_P(RosSensorMessages, Images) {
  const std::vector<std::byte> pixels(12, std::byte{5});
  const auto bytes = image_message(GetParam(), kStamp_ns, 4, 3, "mono8", 4, pixels);
  const auto image = decode_ros_image(GetParam(), bytes);
  ASSERT_TRUE(image) << image.error().context;
  EXPECT_EQ(image->width_px, 4U);
  EXPECT_EQ(image->height_px, 3U);
  EXPECT_EQ(image->encoding, "mono8");
  EXPECT_EQ(image->step_bytes, 4U);
  EXPECT_EQ(image->data.size(), 12U);
  expect_whole_or_nothing(bytes, bytes.size(),
                          [](const auto& part) { return decode_ros_image(GetParam(), part).has_value(); });
  const auto jpeg = compressed_image_message(GetParam(), kStamp_ns, "bgr8; jpeg compressed bgr8", pixels);
  const auto compressed = decode_ros_compressed_image(GetParam(), jpeg);
  ASSERT_TRUE(compressed) << compressed.error().context;
  EXPECT_EQ(compressed->format, "bgr8; jpeg compressed bgr8");
  EXPECT_EQ(compressed->data.size(), 12U);
}

TEST(RosSensorMessage, BigEndianCdrIsRefused) {
  auto bytes = imu_message(RosEncoding::kCdr, kStamp_ns, {0, 0, 0}, {0, 0, 9.8});
  bytes[1] = std::byte{0};
  EXPECT_FALSE(decode_ros_imu(RosEncoding::kCdr, bytes));
}

}  // namespace
}  // namespace edgesplat::io
