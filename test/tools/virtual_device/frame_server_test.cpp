// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/frame_server.hpp"

#include "test/tools/virtual_device/loopback.hpp"

#include <gtest/gtest.h>

#include <string>

namespace edgesplat::virtual_device {
namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
  return {bytes.begin(), bytes.end()};
}

FrameMessage example() {
  FrameMessage message;
  message.sequence = 7;
  message.stamp = sensor_time_from_ns(1700000000123456789);
  message.exposure_s = 0.008F;
  message.gain_db = 6.0F;
  message.stamp_source = sensor::StampSource::kPtp;
  message.width_px = 320;
  message.height_px = 256;
  return message;
}

// Computed apart with Python's struct and zlib modules.
TEST(FrameMessage, HeaderIsByteExact) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  for (const std::byte b : encode_frame_header(example(), bytes_of("picture"))) {
    hex += kDigits[std::to_integer<unsigned>(b) >> 4U];
    hex += kDigits[std::to_integer<unsigned>(b) & 15U];
  }
  EXPECT_EQ(hex,
            "4553464301003000070000000700000015cd853dfe9c97176f12033c"
            "0000c0400101000040010001894fdb166ed8ae5f");
}

TEST(FrameServer, SendsHeaderAndPayloadToTheRobot) {
  auto server = FrameServer::listen(0);
  ASSERT_TRUE(server.has_value()) << server.error().context;
  const UniqueFd robot = connect_to((*server)->port());
  ASSERT_TRUE((*server)->wait_for_robot(std::chrono::seconds(5), {}));
  (*server)->push(example(), bytes_of("picture"));
  (*server)->finish();
  const auto received = read_bytes(robot.get(), 1000);
  ASSERT_EQ(received.size(), kFrameHeaderBytes + 7);
  const auto header = encode_frame_header(example(), bytes_of("picture"));
  EXPECT_TRUE(std::equal(header.begin(), header.end(), received.begin()));
  EXPECT_EQ((*server)->sent(), 1U);
  EXPECT_EQ((*server)->lost(), 0U);
}

TEST(FrameServer, WithoutARobotFramesAreLostAndCounted) {
  auto server = FrameServer::listen(0);
  ASSERT_TRUE(server.has_value());
  EXPECT_FALSE((*server)->wait_for_robot(std::chrono::milliseconds(20), {}));
  for (int i = 0; i < 3; ++i) (*server)->push(example(), bytes_of("picture"));
  (*server)->finish();
  EXPECT_EQ((*server)->sent(), 0U);
  EXPECT_EQ((*server)->lost(), 3U);
}

TEST(FrameServer, TakesTheNextRobotWhenOneGoes) {
  auto server = FrameServer::listen(0);
  ASSERT_TRUE(server.has_value());
  UniqueFd first = connect_to((*server)->port());
  ASSERT_TRUE((*server)->wait_for_robot(std::chrono::seconds(5), {}));
  first.reset();
  const UniqueFd second = connect_to((*server)->port());
  for (int i = 0; i < 50 && (*server)->lost() == 0; ++i) {  // until the broken connection shows
    (*server)->push(example(), bytes_of("picture"));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  (*server)->push(example(), bytes_of("picture"));
  EXPECT_EQ(read_bytes(second.get(), kFrameHeaderBytes).size(), kFrameHeaderBytes);
  (*server)->finish();
  EXPECT_GE((*server)->lost(), 1U);
}

TEST(FrameServer, RefusesAPortInUse) {
  auto first = FrameServer::listen(0);
  ASSERT_TRUE(first.has_value());
  const auto second = FrameServer::listen((*first)->port());
  ASSERT_FALSE(second.has_value());
  EXPECT_EQ(second.error().code, Errc::kIo);
}

}  // namespace
}  // namespace edgesplat::virtual_device
