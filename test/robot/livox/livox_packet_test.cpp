// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/livox_packet.hpp"

#include "test/robot/livox/hex.hpp"
#include "test/robot/livox/packet_bytes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace edgesplat::livox {
namespace {

constexpr const char* kPointPacket =
    "003200000001000500000101000000000000000000000000569eadc015cd853dfe9c9717e803000030f8ffff2c0100004d00";
constexpr const char* kImuPacket =
    "003c000000010009000000010000000000000000000000002628db5b15cd853dfe9c97170ad7233c0ad7a3bc8fc2f53c00000000"
    "00"
    "0000000000803f";

TEST(LivoxPacket, DecodesThePublishedPointPacket) {
  const auto bytes = from_hex(kPointPacket);
  const auto packet = decode_packet(bytes);
  ASSERT_TRUE(packet.has_value()) << to_string(packet.error());
  EXPECT_EQ(packet->type, DataType::kCartesianMm);
  EXPECT_EQ(packet->udp_count, 5);
  EXPECT_EQ(packet->stamp_source, sensor::StampSource::kPtp);
  EXPECT_EQ(to_ns(packet->stamp), 1700000000123456789);
  PointDrops drops;
  const auto points = to_lidar_packet(*packet, host_time_from_ns(7), {}, drops);
  ASSERT_EQ(points.points.size(), 1U);
  EXPECT_EQ(points.points[0].p_in_lidar_m, Eigen::Vector3f(1.0F, -2.0F, 0.3F));
  EXPECT_FLOAT_EQ(points.points[0].reflectivity, 77.0F / 255.0F);
  EXPECT_EQ(points.points[0].offset_ns, 0);
  EXPECT_EQ(to_ns(points.arrival), 7);
}

TEST(LivoxPacket, DecodesThePublishedImuPacket) {
  const auto bytes = from_hex(kImuPacket);
  const auto packet = decode_packet(bytes);
  ASSERT_TRUE(packet.has_value()) << to_string(packet.error());
  ASSERT_EQ(packet->type, DataType::kImu);
  const auto sample = to_imu_sample(*packet, packet->records, {});
  ASSERT_TRUE(sample.has_value());
  EXPECT_NEAR(sample->gyro_radps.x(), 0.01, 1e-8);
  EXPECT_NEAR(sample->gyro_radps.y(), -0.02, 1e-8);
  EXPECT_NEAR(sample->gyro_radps.z(), 0.03, 1e-8);
  EXPECT_NEAR(sample->accel_mps2.z(), 9.80665, 1e-9);
}

TEST(LivoxPacket, SpacesPointTimesFromFirstToLast) {
  PacketFields fields;
  fields.dots = 96;
  for (int i = 0; i < 96; ++i) append_point_mm(fields.records, 1000 + i, 0, 0);
  const auto bytes = packet_bytes(fields);
  ASSERT_EQ(bytes.size(), 1380U);
  const auto packet = decode_packet(bytes);
  ASSERT_TRUE(packet.has_value());
  PointDrops drops;
  const auto out = to_lidar_packet(*packet, {}, {}, drops);
  ASSERT_EQ(out.points.size(), 96U);
  EXPECT_EQ(out.span, nanoseconds(475'000));
  EXPECT_EQ(out.points.front().offset_ns, 0);
  EXPECT_EQ(out.points[19].offset_ns, 95'000);
  EXPECT_EQ(out.points.back().offset_ns, 475'000);
  EXPECT_EQ(out.points[6].line, 2);
}

TEST(LivoxPacket, KeepsTimesWhenPointsAreDropped) {
  PacketFields fields;
  fields.dots = 3;
  fields.interval = 20;
  append_point_mm(fields.records, 0, 0, 0);
  append_point_mm(fields.records, 1000, 0, 0, 10, 0b0000'1000);  // low confidence: rain
  append_point_mm(fields.records, 2000, 0, 0, 10, 0b0001'0000);  // medium confidence: other
  const auto bytes = packet_bytes(fields);
  PointDrops drops;
  const auto out = to_lidar_packet(*decode_packet(bytes), {}, {}, drops);
  ASSERT_EQ(out.points.size(), 1U);
  EXPECT_EQ(out.points[0].offset_ns, 2000);
  EXPECT_EQ(out.points[0].noise_class, 1);
  EXPECT_EQ(drops.no_return, 1U);
  EXPECT_EQ(drops.low_confidence, 1U);
  PointDrops none;
  EXPECT_EQ(to_lidar_packet(*decode_packet(bytes), {}, PointFilter{4}, none).points.size(), 2U);
}

TEST(LivoxPacket, ReadsCentimetresAndAngles) {
  PacketFields fields;
  fields.type = 2;
  ByteWriter cm;
  for (const int value : {123, -456, 7}) cm.write(static_cast<std::int16_t>(value));
  cm.write(std::uint16_t{255});  // reflectivity 255, tag 0
  fields.records = cm.take();
  const auto cm_bytes = packet_bytes(fields);
  PointDrops drops;
  const auto from_cm = to_lidar_packet(*decode_packet(cm_bytes), {}, {}, drops);
  ASSERT_EQ(from_cm.points.size(), 1U);
  EXPECT_TRUE(from_cm.points[0].p_in_lidar_m.isApprox(Eigen::Vector3f(1.23F, -4.56F, 0.07F)));
  EXPECT_FLOAT_EQ(from_cm.points[0].reflectivity, 1.0F);

  fields.type = 3;
  ByteWriter angles;
  angles.write(std::uint32_t{2000});
  angles.write(std::uint16_t{9000});   // zenith 90 degrees: horizontal
  angles.write(std::uint16_t{27000});  // azimuth 270 degrees: to the right
  angles.write(std::uint16_t{0});
  fields.records = angles.take();
  const auto angle_bytes = packet_bytes(fields);
  const auto from_angles = to_lidar_packet(*decode_packet(angle_bytes), {}, {}, drops);
  ASSERT_EQ(from_angles.points.size(), 1U);
  EXPECT_LT((from_angles.points[0].p_in_lidar_m - Eigen::Vector3f(0, -2, 0)).norm(), 1e-6F);
}

TEST(LivoxPacket, RefusesEachKindOfWrongField) {
  PacketFields good;
  append_point_mm(good.records, 1, 2, 3);
  ASSERT_TRUE(decode_packet(packet_bytes(good)).has_value());
  PacketFields version = good;
  version.version = 2;
  EXPECT_EQ(decode_packet(packet_bytes(version)).error(), PacketFault::kVersion);
  PacketFields type = good;
  type.type = 0x11;
  EXPECT_EQ(decode_packet(packet_bytes(type)).error(), PacketFault::kType);
  for (const int dots : {0, 2, 96, 65535}) {
    PacketFields wrong = good;
    wrong.dots = static_cast<std::uint16_t>(dots);
    EXPECT_EQ(decode_packet(packet_bytes(wrong)).error(), PacketFault::kDotCount) << dots;
  }
  auto crc = packet_bytes(good);
  crc.back() ^= std::byte{1};
  EXPECT_EQ(decode_packet(crc).error(), PacketFault::kCrc);
}

TEST(LivoxPacket, RefusesEveryOtherLength) {
  const auto bytes = from_hex(kPointPacket);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const auto packet = decode_packet(std::span(bytes).first(length));
    ASSERT_FALSE(packet.has_value()) << length;
    EXPECT_EQ(packet.error(), PacketFault::kLength);
  }
  auto longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_EQ(decode_packet(longer).error(), PacketFault::kLength);
  EXPECT_EQ(decode_packet(std::vector<std::byte>(65'000)).error(), PacketFault::kLength);
}

TEST(LivoxPacket, NeverUsesAFlippedBitOfStampOrRecords) {
  const auto bytes = from_hex(kPointPacket);
  for (std::size_t bit = 24 * 8; bit < bytes.size() * 8; ++bit) {
    auto flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    ASSERT_FALSE(decode_packet(flipped).has_value()) << bit;
  }
}

TEST(LivoxPacket, RefusesAnImuRecordThatIsNotFinite) {
  PacketFields fields;
  fields.type = 0;
  const std::array<float, 6> values{0, std::numeric_limits<float>::quiet_NaN(), 0, 0, 0, 1};
  fields.records = imu_record(values);
  const auto bytes = packet_bytes(fields);
  const auto packet = decode_packet(bytes);
  ASSERT_TRUE(packet.has_value());
  EXPECT_FALSE(to_imu_sample(*packet, packet->records, {}).has_value());
}

}  // namespace
}  // namespace edgesplat::livox
