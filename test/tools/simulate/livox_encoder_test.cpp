// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/livox_encoder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace edgesplat::simulate {
namespace {

std::string hex(std::span<const std::byte> bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  for (const std::byte b : bytes) {
    out += kDigits[std::to_integer<unsigned>(b) >> 4U];
    out += kDigits[std::to_integer<unsigned>(b) & 15U];
  }
  return out;
}

constexpr SensorTime kStamp = sensor_time_from_ns(1700000000123456789);

// Vectors of ../shared/design/sensor-protocols.md 1.8.
TEST(LivoxEncoder, PointPacketIsByteExact) {
  const std::array<WirePoint, 1> points{WirePoint{1000, -2000, 300, 77, 0}};
  const PacketStamp stamp{5, kStamp, nanoseconds(0), sensor::StampSource::kPtp};
  EXPECT_EQ(hex(encode_point_packet(stamp, points)),
            "003200000001000500000101000000000000000000000000569eadc015cd853dfe9c9717"
            "e803000030f8ffff2c0100004d00");
}

TEST(LivoxEncoder, ImuPacketIsByteExact) {
  const PacketStamp stamp{9, kStamp, nanoseconds(0), sensor::StampSource::kPtp};
  EXPECT_EQ(hex(encode_imu_packet(stamp, {0.01F, -0.02F, 0.03F}, {0.0F, 0.0F, 1.0F})),
            "003c0000000100090000000100000000000000000000000026"
            "28db5b15cd853dfe9c97170ad7233c0ad7a3bc8fc2f53c00000000000000000000803f");
}

TEST(LivoxEncoder, FullPacketHasTheDocumentedSizeAndInterval) {
  const std::array<WirePoint, kPointsPerPacket> points{};
  const PacketStamp stamp{65535, kStamp, nanoseconds(475000), sensor::StampSource::kFreeRunning};
  const auto packet = encode_point_packet(stamp, points);
  ASSERT_EQ(packet.size(), 1380U);
  EXPECT_EQ(hex(std::span(packet).first(12)), "0064058e126000ffff000100");  // 1380, 4750, 96, 65535, 0, 1, 0
}

}  // namespace
}  // namespace edgesplat::simulate
