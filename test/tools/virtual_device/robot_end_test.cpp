// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The robot's drivers at the other end of the virtual devices: neither side shares code with the other.
#include "common/time/clock.hpp"
#include "robot/drivers/frame_socket/frame_client.hpp"
#include "robot/drivers/livox/livox_source.hpp"
#include "tools/simulate/livox_encoder.hpp"
#include "tools/virtual_device/fault_injector.hpp"
#include "tools/virtual_device/frame_server.hpp"

#include <gtest/gtest.h>

#include <array>

namespace edgesplat::virtual_device {
namespace {

TEST(RobotEnd, FrameClientReadsWhatTheServerSends) {
  auto server = FrameServer::listen(0);
  ASSERT_TRUE(server.has_value()) << server.error().context;
  const SteadyClock clock;
  frame_socket::FrameClientConfig config;
  config.port = (*server)->port();
  auto client = frame_socket::FrameClient::create(config, clock);
  ASSERT_TRUE(client.has_value());
  (void)client->receive({}, std::chrono::milliseconds(50));  // connects; nothing is sent yet
  ASSERT_TRUE((*server)->wait_for_robot(std::chrono::seconds(5), {}));

  for (std::uint32_t k = 0; k < 5; ++k) {
    FrameMessage message;
    message.sequence = 100 + k;
    message.stamp = sensor_time_from_ns(1700000000000000000 + k);
    message.exposure_s = 0.008F;
    message.gain_db = -1.5F;
    message.stamp_source = sensor::StampSource::kPtp;
    message.format = k % 2 == 0 ? FrameFormat::kJpeg : FrameFormat::kPng;
    message.width_px = 320;
    message.height_px = 256;
    const std::vector<std::byte> payload(1000 + k, std::byte{0x45});
    (*server)->push(message, payload);
    const auto received = client->receive({}, std::chrono::seconds(5));
    ASSERT_TRUE(received.has_value()) << client->why_not_connected();
    const auto& header = received->frame.header;
    EXPECT_EQ(header.sequence, 100 + k);
    EXPECT_EQ(to_ns(header.stamp), 1700000000000000000 + k);
    EXPECT_EQ(header.exposure_s, 0.008F);
    EXPECT_EQ(header.gain_db, -1.5F);
    EXPECT_EQ(header.stamp_source, sensor::StampSource::kPtp);
    EXPECT_EQ(header.width_px, 320);
    EXPECT_EQ(header.height_px, 256);
    EXPECT_EQ(received->frame.payload, payload);
  }
  EXPECT_EQ(client->assembler_counters().bytes_skipped, 0U);
}

TEST(RobotEnd, LivoxSourceCountsWhatTheBadWireLost) {
  livox::LivoxSource source;
  FaultInjector faults({.flip = 0.0, .drop = 0.05}, 3);
  const std::array<simulate::WirePoint, simulate::kPointsPerPacket> points{
      simulate::WirePoint{1000, 0, 0, 10, 0}};
  constexpr int kPackets = 4000;
  std::uint64_t received = 0, lost_at_the_ends = 0;
  for (int k = 0; k < kPackets; ++k) {
    const std::int64_t at_ns = 1700000000000000000 + k * 480000LL;
    const simulate::PacketStamp stamp{static_cast<std::uint16_t>(65000 + k), sensor_time_from_ns(at_ns),
                                      nanoseconds(475000), sensor::StampSource::kPtp};
    auto datagram = simulate::encode_point_packet(stamp, points);
    if (!faults.pass(datagram)) {
      lost_at_the_ends = received == 0 ? lost_at_the_ends + 1 : lost_at_the_ends;
      continue;
    }
    ++received;
    EXPECT_TRUE(source.on_points(datagram, host_time_from_ns(at_ns + 500000)).has_value());
  }
  EXPECT_GT(faults.dropped(), 100U);
  EXPECT_EQ(source.counters().points.packets, received);
  EXPECT_NEAR(static_cast<double>(source.counters().points.lost),
              static_cast<double>(faults.dropped() - lost_at_the_ends),
              3.0);  // a loss at the very end has no witness
}

TEST(RobotEnd, LivoxSourceRefusesFlippedRecords) {
  livox::LivoxSource source;
  const std::array<simulate::WirePoint, simulate::kPointsPerPacket> points{};
  for (std::size_t bit = 0; bit < 8 * 1380; bit += 37) {
    auto datagram = simulate::encode_point_packet(
        {1, sensor_time_from_ns(1700000000000000000), nanoseconds(475000)}, points);
    datagram[bit / 8] ^= std::byte{1} << (bit % 8);
    if (bit / 8 < 24) continue;  // the protocol's checksum does not cover these
    EXPECT_FALSE(source.on_points(datagram, host_time_from_ns(1700000000000000000)).has_value()) << bit;
  }
}

}  // namespace
}  // namespace edgesplat::virtual_device
