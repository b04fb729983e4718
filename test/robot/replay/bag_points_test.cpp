// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/bag_points.hpp"

#include "robot/drivers/livox/livox_packet.hpp"
#include "test/common/io/ros_samples.hpp"
#include "test/robot/livox/packet_bytes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace edgesplat::replay {
namespace {

using io::RosEncoding;

constexpr std::int64_t kStamp_ns = 1'700'000'000'000'000'000;
constexpr HostTime kArrival = host_time_from_ns(kStamp_ns + 100'000'000);

struct Expected {
  double x_m;
  std::int64_t t_ns;  ///< after the header's stamp
};

void expect_packet(const Result<std::optional<sensor::Measurement>>& converted,
                   const std::vector<Expected>& points, std::int64_t tolerance_ns = 0) {
  ASSERT_TRUE(converted) << converted.error().context;
  ASSERT_TRUE(*converted && std::holds_alternative<sensor::LidarPacket>(**converted));
  const auto& packet = std::get<sensor::LidarPacket>(**converted);
  ASSERT_EQ(packet.points.size(), points.size());
  EXPECT_EQ(packet.arrival, kArrival);
  EXPECT_EQ(packet.points.front().offset_ns, 0);
  EXPECT_EQ(packet.points.back().offset_ns, packet.span.count());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_FLOAT_EQ(packet.points[i].p_in_lidar_m.x(), static_cast<float>(points[i].x_m)) << i;
    EXPECT_NEAR(static_cast<double>(to_ns(packet.stamp) + packet.points[i].offset_ns - kStamp_ns),
                static_cast<double>(points[i].t_ns), static_cast<double>(tolerance_ns))
        << i;
  }
}

/// x, y, z and one more field, packed; padding after it.
template <typename T>
io::SampleCloud cloud_with(const char* field, std::uint8_t type,
                           const std::vector<std::pair<float, T>>& points) {
  ByteWriter data;
  for (const auto& [x, value] : points) {
    for (const float v : {x, 0.5F, -0.5F}) data.write(v);
    data.write(80.0F);
    data.write(value);
    data.write(std::uint16_t{3});
  }
  const auto step = static_cast<std::uint32_t>(16 + sizeof(T) + 2);
  return {{{"x", 0, 7},
           {"y", 4, 7},
           {"z", 8, 7},
           {"intensity", 12, 7},
           {field, 16, type},
           {"ring", static_cast<std::uint32_t>(16 + sizeof(T)), 4}},
          step,
          static_cast<std::uint32_t>(points.size()),
          1,
          data.take()};
}

Result<std::optional<sensor::Measurement>> convert(BagPoints& points, const io::SampleCloud& sample) {
  const auto bytes = io::cloud_message(RosEncoding::kRos1, kStamp_ns, sample);
  const auto cloud = io::decode_ros_point_cloud(RosEncoding::kRos1, bytes);
  EXPECT_TRUE(cloud) << cloud.error().context;
  return points.convert(*cloud, kArrival);
}

TEST(BagPoints, ACustomMsgEndsAsThePacketThatTheLivoxDriverMakes) {
  livox::PacketFields fields;
  std::vector<io::SamplePoint> ros;
  constexpr int kPoints = 96;
  fields.dots = kPoints;
  for (int i = 0; i < kPoints; ++i) {
    const std::uint8_t tag = i % 7 == 3 ? 0x02 : (i % 5 == 1 ? 0x04 : 0);  // SDK2: low and medium confidence
    const int x_mm = i % 11 == 4 ? 0 : 20'000 + 137 * i;
    const int y_mm = x_mm == 0 ? 0 : 31 * i;
    const int z_mm = x_mm == 0 ? 0 : -1234;
    livox::append_point_mm(fields.records, x_mm, y_mm, z_mm, static_cast<std::uint8_t>(2 * i), tag);
    ros.push_back({static_cast<std::uint32_t>(475'000LL * i / (kPoints - 1)), static_cast<float>(x_mm * 1e-3),
                   static_cast<float>(y_mm * 1e-3), static_cast<float>(z_mm * 1e-3),
                   static_cast<std::uint8_t>(2 * i), tag, static_cast<std::uint8_t>(i % 4)});
  }
  const auto datagram = livox::packet_bytes(fields);
  const auto decoded = livox::decode_packet(datagram);
  ASSERT_TRUE(decoded);
  livox::PointDrops drops;
  const sensor::LidarPacket driver = livox::to_lidar_packet(*decoded, kArrival, {}, drops);
  for (const auto encoding : {RosEncoding::kRos1, RosEncoding::kCdr}) {
    const auto message = io::decode_livox_custom(encoding, io::livox_message(encoding, kStamp_ns, ros));
    ASSERT_TRUE(message) << message.error().context;
    BagPoints points{BagSettings{}};
    const auto converted = points.convert(*message, LivoxTags::kSdk2, kArrival);
    ASSERT_TRUE(converted && *converted);
    const auto& packet = std::get<sensor::LidarPacket>(**converted);
    EXPECT_EQ(packet.stamp, driver.stamp);
    EXPECT_EQ(packet.stamp_source, driver.stamp_source);
    EXPECT_EQ(packet.span, driver.span);
    EXPECT_EQ(points.dropped(), drops.no_return + drops.low_confidence);
    ASSERT_EQ(packet.points.size(), driver.points.size());
    for (std::size_t i = 0; i < packet.points.size(); ++i) {
      EXPECT_EQ(packet.points[i].p_in_lidar_m, driver.points[i].p_in_lidar_m) << i;
      EXPECT_EQ(packet.points[i].offset_ns, driver.points[i].offset_ns) << i;
      EXPECT_EQ(packet.points[i].reflectivity, driver.points[i].reflectivity) << i;
      EXPECT_EQ(packet.points[i].noise_class, driver.points[i].noise_class) << i;
      EXPECT_EQ(packet.points[i].line, driver.points[i].line) << i;
    }
  }
}

TEST(BagPoints, TagsOfTheTwoLivoxDriversMeanDifferentThings) {
  const auto bytes =
      io::livox_message(RosEncoding::kRos1, kStamp_ns,
                        {{0, 1, 0, 0, 0, 0x20, 0}, {10, 2, 0, 0, 0, 0x01, 0}, {20, 3, 0, 0, 0, 0, 0}});
  const auto message = io::decode_livox_custom(RosEncoding::kRos1, bytes);
  ASSERT_TRUE(message);
  BagPoints points{BagSettings{}};
  // SDK1: 0x20 is a third return, 0x01 noise for sure. SDK2: 0x20 is low confidence, 0x01 medium.
  expect_packet(points.convert(*message, LivoxTags::kSdk1, kArrival), {{1, 0}, {3, 20}});
  expect_packet(points.convert(*message, LivoxTags::kSdk2, kArrival), {{2, 10}, {3, 20}});
}

TEST(BagPoints, VelodyneTimesAreSecondsAndMayPrecedeTheStamp) {
  BagPoints points{BagSettings{}};
  expect_packet(convert(points, cloud_with<float>("time", 7, {{2, 0.0F}, {1, -0.09F}, {3, 0.01F}})),
                {{1, -90'000'000}, {2, 0}, {3, 10'000'000}}, 4);  // a float32 of 0.09 s is 4 ns off
}

TEST(BagPoints, OusterTimesAreNanoseconds) {
  BagPoints points{BagSettings{}};
  const auto converted =
      convert(points, cloud_with<std::uint32_t>("t", 6, {{1, 0U}, {2, 50'000'001U}, {3, 99'999'999U}}));
  expect_packet(converted, {{1, 0}, {2, 50'000'001}, {3, 99'999'999}});
  const auto& packet = std::get<sensor::LidarPacket>(**converted);
  EXPECT_EQ(packet.points[0].line, 3);
  EXPECT_FLOAT_EQ(packet.points[0].reflectivity, 80.0F / 255.0F);
}

TEST(BagPoints, HesaiTimesAreOfDayInSecondsAndLivoxInNanoseconds) {
  BagPoints hesai{BagSettings{}};
  const double s = static_cast<double>(kStamp_ns) * 1e-9;
  expect_packet(convert(hesai, cloud_with<double>("timestamp", 8, {{1, s}, {2, s + 0.05}, {3, s + 0.1}})),
                {{1, 0}, {2, 50'000'000}, {3, 100'000'000}}, 500);
  BagPoints livox{BagSettings{}};
  const auto ns = static_cast<double>(kStamp_ns);
  expect_packet(convert(livox, cloud_with<double>("timestamp", 8, {{1, ns}, {2, ns + 5e7}, {3, ns + 1e8}})),
                {{1, 0}, {2, 50'000'000}, {3, 100'000'000}}, 500);
}

TEST(BagPoints, TimesOfAnotherDayAreTakenAfterTheStamp) {
  BagPoints points{BagSettings{}};
  expect_packet(convert(points, cloud_with<double>("timestamp", 8, {{1, 9e8}, {2, 9e8 + 0.05}})),
                {{1, 0}, {2, 50'000'000}}, 500);
}

TEST(BagPoints, OtherUnitsAreFoundByTheFirstScanOrTold) {
  BagPoints found{BagSettings{}};
  expect_packet(convert(found, cloud_with<float>("time", 7, {{1, 0.0F}, {2, 100'000.0F}})),  // microseconds
                {{1, 0}, {2, 100'000'000}});
  expect_packet(convert(found, cloud_with<float>("time", 7, {{1, 0.0F}, {2, 1.0F}})), {{1, 0}, {2, 1000}});
  BagSettings settings;
  settings.point_time_unit = PointTimeUnit::kMicroseconds;
  BagPoints told{settings};
  expect_packet(convert(told, cloud_with<std::uint32_t>("t", 6, {{1, 0U}, {2, 70'000U}})),
                {{1, 0}, {2, 70'000'000}});
  BagPoints wrong{BagSettings{}};
  const auto refused = convert(wrong, cloud_with<std::uint32_t>("t", 6, {{1, 0U}, {2, 4'000'000'000U}}));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().context.find("point_time_unit"), std::string::npos);
}

TEST(BagPoints, WithoutTimesItIsAWholeScan) {
  BagPoints points{BagSettings{}};
  for (const char* name : {"curvature", "time"}) {
    const auto converted = convert(points, cloud_with<float>(name, 7, {{1, 0.0F}, {2, 0.0F}}));
    ASSERT_TRUE(converted && *converted);
    const auto* scan = std::get_if<sensor::LidarScan>(&**converted);
    ASSERT_NE(scan, nullptr) << name;
    EXPECT_FALSE(scan->has_point_times);
    EXPECT_EQ(to_ns(scan->stamp), kStamp_ns);
    EXPECT_EQ(scan->points.size(), 2U);
  }
}

TEST(BagPoints, DropsWhatIsNoReturn) {
  BagPoints points{BagSettings{}};
  auto sample =
      cloud_with<float>("time", 7, {{NAN, 0.0F}, {1, 0.01F}, {INFINITY, 0.02F}, {2, NAN}, {3, 0.05F}});
  expect_packet(convert(points, sample), {{1, 10'000'000}, {3, 50'000'000}}, 2);
  EXPECT_EQ(points.dropped(), 3U);
  sample.width = 0;
  sample.data.clear();
  const auto none = convert(points, sample);
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->has_value());
  sample = cloud_with<float>("time", 7, {{1, 0.0F}});
  sample.fields[2].name = "depth";
  EXPECT_FALSE(convert(points, sample));
}

TEST(BagPoints, OffsetsAndClocksAreAsTold) {
  BagSettings settings;
  settings.lidar_stamp_offset_s = -0.1;
  settings.clock = StampClock::kArrival;
  BagPoints points{settings};
  const auto converted = convert(points, cloud_with<float>("time", 7, {{1, 0.0F}, {2, 0.1F}}));
  ASSERT_TRUE(converted && *converted);
  const auto& packet = std::get<sensor::LidarPacket>(**converted);
  EXPECT_EQ(to_ns(packet.stamp), kStamp_ns - 100'000'000);
  EXPECT_EQ(packet.stamp_source, sensor::StampSource::kFreeRunning);
}

}  // namespace
}  // namespace edgesplat::replay
