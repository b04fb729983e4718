// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/livox_source.hpp"

#include "test/robot/livox/packet_bytes.hpp"

#include <gtest/gtest.h>

#include <array>

namespace edgesplat::livox {
namespace {

constexpr std::int64_t kPacket_ns = 480'000;
constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

/// Packet number `index` of a healthy stream.
PacketFields healthy(int index) {
  PacketFields fields;
  fields.udp_count = static_cast<std::uint16_t>(index);
  fields.stamp_ns = static_cast<std::uint64_t>(kStart_ns + index * kPacket_ns);
  append_point_mm(fields.records, 1000, 2000, 3000);
  return fields;
}
HostTime arrival_of(int index) {
  return host_time_from_ns(5'000'000 + index * kPacket_ns);
}

TEST(LivoxSource, CountsLostPackets) {
  LivoxSource source;
  for (const int index : {0, 1, 2, 5, 6})
    EXPECT_TRUE(source.on_points(packet_bytes(healthy(index)), arrival_of(index)));
  EXPECT_EQ(source.counters().points.packets, 5U);
  EXPECT_EQ(source.counters().points.lost, 2U);
  EXPECT_EQ(source.counters().points.stamp_gaps, 0U);
  EXPECT_EQ(source.counters().points_out, 5U);
}

TEST(LivoxSource, CounterWrapsAndFrameRestartsAreNoLoss) {
  LivoxSource source;
  for (int index = 65'530; index < 65'545; ++index)
    EXPECT_TRUE(source.on_points(packet_bytes(healthy(index)), arrival_of(index)));
  PacketFields next_frame = healthy(65'545);
  next_frame.udp_count = 0;
  next_frame.frame_count = 1;
  EXPECT_TRUE(source.on_points(packet_bytes(next_frame), arrival_of(65'545)));
  EXPECT_EQ(source.counters().points.lost, 0U);
}

TEST(LivoxSource, SilenceWithoutAHoleIsAStampGap) {
  LivoxSource source;
  for (int index = 0; index < 4; ++index) {
    PacketFields fields = healthy(index < 2 ? index : index + 3);
    fields.udp_count = static_cast<std::uint16_t>(index);
    EXPECT_TRUE(source.on_points(packet_bytes(fields), arrival_of(index < 2 ? index : index + 3)));
  }
  EXPECT_EQ(source.counters().points.lost, 0U);
  EXPECT_EQ(source.counters().points.stamp_gaps, 1U);
}

TEST(LivoxSource, UsesOvertakenPacketsOnceAndRefusesDuplicates) {
  LivoxSource source;
  for (const int index : {0, 2, 1})
    EXPECT_TRUE(source.on_points(packet_bytes(healthy(index)), arrival_of(2)));
  for (const int index : {0, 1, 2})
    EXPECT_FALSE(source.on_points(packet_bytes(healthy(index)), arrival_of(2)));
  EXPECT_EQ(source.counters().points.reordered, 1U);
  EXPECT_EQ(source.counters().points.duplicate, 3U);
  EXPECT_EQ(source.counters().points.lost, 0U);
}

TEST(LivoxSource, RefusesStampsThatCannotBe) {
  LivoxSource source;
  EXPECT_TRUE(source.on_points(packet_bytes(healthy(10)), arrival_of(10)));
  PacketFields back = healthy(11);
  back.stamp_ns = static_cast<std::uint64_t>(kStart_ns + 10 * kPacket_ns - 1'100'000);
  EXPECT_FALSE(source.on_points(packet_bytes(back), arrival_of(11)));
  PacketFields ahead = healthy(11);
  ahead.stamp_ns += 1'100'000'000;
  EXPECT_FALSE(source.on_points(packet_bytes(ahead), arrival_of(11)));
  EXPECT_TRUE(source.on_points(packet_bytes(healthy(11)), arrival_of(11)));
  EXPECT_EQ(source.counters().points.bad_stamp, 2U);
}

TEST(LivoxSource, ALongSilenceIsNoJump) {
  LivoxSource source;
  EXPECT_TRUE(source.on_points(packet_bytes(healthy(0)), arrival_of(0)));
  EXPECT_TRUE(
      source.on_points(packet_bytes(healthy(20'000)), arrival_of(20'000)));  // 9.6 s later on both clocks
  EXPECT_EQ(source.counters().points.bad_stamp, 0U);
}

TEST(LivoxSource, BelievesARestartedDeviceAfterAWhile) {
  LivoxSource source;
  EXPECT_TRUE(source.on_points(packet_bytes(healthy(1000)), arrival_of(1000)));
  int used = 0;
  for (int index = 0; index < 30; ++index) {
    PacketFields fields = healthy(index);
    fields.stamp_ns = static_cast<std::uint64_t>(1'000'000 + index * kPacket_ns);  // ns since power-on
    used += source.on_points(packet_bytes(fields), arrival_of(1001 + index)) ? 1 : 0;
  }
  EXPECT_EQ(used, 30 - (StreamMonitor::kAgreeingForRestart - 1));
  EXPECT_EQ(source.counters().points.clock_changes, 1U);
}

TEST(LivoxSource, ANewStampSourceIsAClockChange) {
  LivoxSource source;
  PacketFields before = healthy(0);
  before.time_type = 0;
  before.stamp_ns = 12'345'678;
  EXPECT_TRUE(source.on_points(packet_bytes(before), arrival_of(0)));
  EXPECT_TRUE(source.on_points(packet_bytes(healthy(1)), arrival_of(1)));
  EXPECT_EQ(source.counters().points.clock_changes, 1U);
  EXPECT_EQ(source.counters().points.bad_stamp, 0U);
}

TEST(LivoxSource, CountsDamageByKindAndUsesNoneOfIt) {
  LivoxSource source;
  auto crc = packet_bytes(healthy(0));
  crc[40] ^= std::byte{4};
  EXPECT_FALSE(source.on_points(crc, {}));
  EXPECT_FALSE(source.on_points(std::vector<std::byte>(10), {}));
  PacketFields type = healthy(0);
  type.type = 7;
  EXPECT_FALSE(source.on_points(packet_bytes(type), {}));
  PacketFields version = healthy(0);
  version.version = 9;
  EXPECT_FALSE(source.on_points(packet_bytes(version), {}));
  EXPECT_FALSE(source.on_imu(packet_bytes(healthy(0)), {}));  // points on the IMU channel
  const auto counters = source.counters();
  EXPECT_EQ(counters.bad_crc, 1U);
  EXPECT_EQ(counters.bad_length, 1U);
  EXPECT_EQ(counters.bad_type, 2U);
  EXPECT_EQ(counters.bad_version, 1U);
  EXPECT_EQ(counters.points.packets + counters.imu.packets, 0U);
}

TEST(LivoxSource, HandsOnImuSamples) {
  LivoxSource source;
  PacketFields fields;
  fields.type = 0;
  const std::array<float, 6> values{0.1F, 0, 0, 0, 0, 1};
  fields.records = imu_record(values);
  const auto measurement = source.on_imu(packet_bytes(fields), host_time_from_ns(3));
  ASSERT_TRUE(measurement.has_value());
  const auto* sample = std::get_if<sensor::ImuSample>(&*measurement);
  ASSERT_NE(sample, nullptr);
  EXPECT_EQ(to_ns(sample->arrival), 3);
  EXPECT_EQ(sample->stamp_source, sensor::StampSource::kPtp);
}

}  // namespace
}  // namespace edgesplat::livox
