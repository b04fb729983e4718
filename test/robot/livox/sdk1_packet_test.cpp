// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/sdk1_packet.hpp"

#include "robot/drivers/livox/livox_source.hpp"
#include "test/robot/livox/hex.hpp"
#include "test/robot/livox/packet_bytes.hpp"
#include "test/robot/livox/sdk1_bytes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace edgesplat::livox {
namespace {

constexpr std::uint64_t kStamp_ns = 1'700'000'000'000'000'000U;

struct TypeRow {
  std::uint8_t type;
  std::size_t datagram_bytes;
  std::uint16_t shots;
};
// sensor-protocols sheet, 2.5
constexpr std::array kTypes{TypeRow{0, 1318, 100}, TypeRow{1, 918, 100}, TypeRow{2, 1362, 96},
                            TypeRow{3, 978, 96},   TypeRow{4, 1362, 48}, TypeRow{5, 786, 48},
                            TypeRow{6, 42, 1},     TypeRow{7, 1278, 30}, TypeRow{8, 678, 30}};

/// One return: 3 m away along x, in the form of the data type.
void append_return(ByteWriter& records, std::uint8_t type, std::int32_t x_mm, std::uint8_t tag) {
  const bool spherical = type == 1 || type == 3 || type == 5 || type == 8;
  records.write(x_mm);
  if (!spherical) {
    records.write(std::int32_t{0});
    records.write(std::int32_t{0});
  } else if (type < 5) {
    records.write(std::uint16_t{9000});  // zenith 90 degrees: along x
    records.write(std::uint16_t{0});
  }
  records.write(std::uint8_t{51});
  if (type > 1) records.write(tag);
}

std::vector<std::byte> records_of(std::uint8_t type, std::uint16_t shots, std::uint8_t tag = 0) {
  ByteWriter records;
  const int returns = type == 4 || type == 5 ? 2 : (type >= 7 ? 3 : 1);
  for (std::uint16_t shot = 0; shot < shots; ++shot) {
    if (type == 5 || type == 8) {
      records.write(std::uint16_t{9000});
      records.write(std::uint16_t{0});
    }
    for (int i = 0; i < returns; ++i) append_return(records, type, 3000 + 10 * shot + i, tag);
  }
  return records.take();
}

TEST(Sdk1Packet, DecodesEveryPointTypeOfThePublishedTable) {
  for (const TypeRow& row : kTypes) {
    if (row.type == 6) continue;
    const auto bytes = sdk1_packet(row.type, 1, kStamp_ns, records_of(row.type, row.shots));
    ASSERT_EQ(bytes.size(), row.datagram_bytes) << int{row.type};
    const auto packet = decode_sdk1_packet(bytes);
    ASSERT_TRUE(packet.has_value()) << int{row.type} << to_string(packet.error());
    EXPECT_EQ(packet->shot_count, row.shots);
    EXPECT_EQ(packet->version, 5);
    EXPECT_EQ(packet->status, 0x4200U);
    EXPECT_EQ(packet->stamp_source, sensor::StampSource::kPtp);
    PointDrops drops;
    const auto points = to_lidar_packet(*packet, {}, {}, drops);
    const std::size_t returns = points.points.size() / row.shots;
    EXPECT_EQ(returns, row.type == 4 || row.type == 5 ? 2U : (row.type >= 7 ? 3U : 1U));
    for (std::size_t i = 0; i < points.points.size(); ++i) {
      const auto shot = static_cast<float>(i / returns);
      const auto of_shot = static_cast<float>(i % returns);
      const sensor::LidarPoint& point = points.points[i];
      EXPECT_NEAR(point.p_in_lidar_m.x(), 3.0F + 0.01F * shot + 0.001F * of_shot, 1e-5F) << int{row.type};
      EXPECT_NEAR(point.p_in_lidar_m.z(), 0.0F, 1e-5F);
      EXPECT_FLOAT_EQ(point.reflectivity, 0.2F);
      EXPECT_EQ(point.offset_ns, std::lround(static_cast<double>(i / returns) * 1e9 / 240e3));
      EXPECT_EQ(point.line, (i / returns) % 6);
    }
    EXPECT_NEAR(static_cast<double>(points.span.count()), (row.shots - 1) * 1e9 / 240e3, 1.0);
  }
}

TEST(Sdk1Packet, RefusesEveryOtherLengthAndType) {
  for (const TypeRow& row : kTypes) {
    auto bytes = sdk1_packet(row.type, 0, kStamp_ns, std::vector<std::byte>(row.datagram_bytes - 18));
    EXPECT_TRUE(decode_sdk1_packet(bytes).has_value()) << int{row.type};
    for (std::size_t length = 0; length < bytes.size(); ++length)
      ASSERT_FALSE(decode_sdk1_packet(std::span(bytes).first(length)).has_value())
          << int{row.type} << " " << length;
    bytes.push_back(std::byte{0});
    EXPECT_EQ(decode_sdk1_packet(bytes).error(), PacketFault::kDotCount);
  }
  const auto unknown = sdk1_packet(9, 0, kStamp_ns, std::vector<std::byte>(24));
  EXPECT_EQ(decode_sdk1_packet(unknown).error(), PacketFault::kType);
  EXPECT_EQ(decode_sdk1_packet(std::vector<std::byte>(1501)).error(), PacketFault::kLength);
}

TEST(Sdk1Packet, ReadsEveryTimeType) {
  const std::vector<std::byte> imu(24);
  const auto stamp_of = [&](std::uint8_t type, std::uint64_t ns) {
    return decode_sdk1_packet(sdk1_packet(6, type, ns, imu));
  };
  EXPECT_EQ(to_ns(stamp_of(0, 123)->stamp), 123);
  EXPECT_EQ(stamp_of(0, 123)->stamp_source, sensor::StampSource::kFreeRunning);
  EXPECT_EQ(stamp_of(1, 123)->stamp_source, sensor::StampSource::kPtp);
  EXPECT_TRUE(stamp_of(4, 123)->since_pulse);
  EXPECT_EQ(stamp_of(5, 123).error(), PacketFault::kStamp);
  EXPECT_GE(to_ns(stamp_of(0, std::numeric_limits<std::uint64_t>::max())->stamp), 0);

  const auto utc = decode_sdk1_packet(sdk1_packet(6, 3, from_hex("170b0e160008af2f"), imu));
  ASSERT_TRUE(utc.has_value());  // 2023-11-14 22:13:20 = 0x2FAF0800 us into the hour
  EXPECT_EQ(to_ns(utc->stamp), 1'700'000'000'000'000'000);
  EXPECT_EQ(utc->stamp_source, sensor::StampSource::kGps);
  const auto no_date = decode_sdk1_packet(sdk1_packet(6, 3, from_hex("170d0e160008af2f"), imu));
  EXPECT_EQ(no_date.error(), PacketFault::kStamp);
}

TEST(Sdk1Packet, DropsWhatTheLidarCallsNoise) {
  // Fields: position noise, intensity noise; 1 = noise for sure, 2 = moderate, 3 = hardly.
  struct Row {
    std::uint8_t tag;
    bool kept;
    std::uint8_t noise_class;
  };
  for (const Row& row :
       {Row{0b0000, true, 0}, Row{0b0001, false, 0}, Row{0b0100, false, 0}, Row{0b0010, true, 1},
        Row{0b1000, true, 1}, Row{0b0011, true, 1}, Row{0b11'0000, true, 0}, Row{0b0110, false, 0}}) {
    const auto packet_data = sdk1_packet(2, 0, kStamp_ns, records_of(2, 96, row.tag));
    PointDrops drops;
    const auto points = to_lidar_packet(*decode_sdk1_packet(packet_data), {}, {}, drops);
    EXPECT_EQ(points.points.size(), row.kept ? 96U : 0U) << int{row.tag};
    EXPECT_EQ(drops.low_confidence, row.kept ? 0U : 96U);
    if (row.kept) {
      EXPECT_EQ(points.points[5].noise_class, row.noise_class);
    }
  }
  const auto nothing = sdk1_packet(2, 0, kStamp_ns, std::vector<std::byte>(96 * 14));
  PointDrops drops;
  EXPECT_TRUE(to_lidar_packet(*decode_sdk1_packet(nothing), {}, {}, drops).points.empty());
  EXPECT_EQ(drops.no_return, 96U);
}

TEST(Sdk1Packet, PulseTimeGoesOnOverEachPulse) {
  PulseTime time;
  // 1 s of packets every 100 ms, arriving up to 90 ms late; the count restarts at each pulse.
  for (int k = 0; k < 40; ++k) {
    const std::int64_t true_ns = 700'000'000LL + k * 100'000'000LL;
    const HostTime arrival = host_time_from_ns(5'000'000'000 + true_ns + (k % 4) * 30'000'000LL);
    EXPECT_EQ(to_ns(time.unwrap(sensor_time_from_ns(true_ns % 1'000'000'000), arrival)), true_ns);
  }
  // After 3.2 s of silence the seconds in between are not lost.
  const HostTime later = host_time_from_ns(5'000'000'000 + 7'800'000'000);
  EXPECT_EQ(to_ns(time.unwrap(sensor_time_from_ns(800'000'000), later)), 7'800'000'000);
}

TEST(Sdk1Source, CountsLossByStampsAlone) {
  LivoxSource source(Protocol::kSdk1);
  const auto records = records_of(2, 96);
  for (const int index : {0, 1, 2, 5, 6}) {
    const auto bytes =
        sdk1_packet(2, 0, static_cast<std::uint64_t>(1'000'000'000 + index * 400'000), records);
    EXPECT_TRUE(source.on_points(bytes, host_time_from_ns(9'000'000'000 + index * 400'000)).has_value());
  }
  EXPECT_EQ(source.counters().points.packets, 5U);
  EXPECT_EQ(source.counters().points.lost, 2U);
  EXPECT_EQ(source.counters().points.stamp_gaps, 0U);
}

TEST(Sdk1Source, RefusesTheOtherChannelsTypeAndValuesThatAreNone) {
  LivoxSource source(Protocol::kSdk1);
  const auto points = sdk1_packet(2, 0, kStamp_ns, records_of(2, 96));
  const auto imu = sdk1_packet(6, 0, kStamp_ns, imu_record(std::array<float, 6>{0.1F, 0, 0, 0, 0, 1}));
  EXPECT_FALSE(source.on_imu(points, {}).has_value());
  EXPECT_FALSE(source.on_points(imu, {}).has_value());
  EXPECT_EQ(source.counters().bad_type, 2U);
  const auto sample = source.on_imu(imu, {});
  ASSERT_TRUE(sample.has_value());
  EXPECT_NEAR(std::get<sensor::ImuSample>(*sample).accel_mps2.z(), 9.80665, 1e-9);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto broken = sdk1_packet(6, 0, kStamp_ns, imu_record(std::array<float, 6>{nan, 0, 0, 0, 0, 1}));
  EXPECT_FALSE(source.on_imu(broken, {}).has_value());
  EXPECT_EQ(source.counters().bad_value, 1U);
}

}  // namespace
}  // namespace edgesplat::livox
