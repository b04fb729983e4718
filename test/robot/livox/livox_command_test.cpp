// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/livox_command.hpp"

#include "common/base/bytes.hpp"
#include "robot/drivers/livox/checksum.hpp"
#include "test/robot/livox/hex.hpp"

#include <gtest/gtest.h>

#include <string>

namespace edgesplat::livox {
namespace {

constexpr Ipv4 kHost{192, 168, 1, 5};

/// A frame as the LiDAR would send it.
std::vector<std::byte> lidar_frame(CommandId id, bool ack, std::span<const std::byte> content) {
  ByteWriter writer;
  writer.write(std::uint8_t{0xAA});
  writer.write(std::uint8_t{0});
  writer.write(static_cast<std::uint16_t>(24 + content.size()));
  writer.write(std::uint32_t{42});
  writer.write(static_cast<std::uint16_t>(id));
  writer.write(static_cast<std::uint8_t>(ack ? 1 : 0));
  writer.write(std::uint8_t{1});
  for (int i = 0; i < 6; ++i) writer.write(std::uint8_t{0});
  writer.write(crc16(writer.bytes()));
  writer.write(crc32(content));
  writer.write_bytes(content);
  return writer.take();
}

TEST(LivoxChecksum, GivesThePublishedCheckValues) {
  const std::string digits = "123456789";
  const auto bytes = std::as_bytes(std::span(digits.data(), digits.size()));
  EXPECT_EQ(crc16(bytes), 0x29B1);
  EXPECT_EQ(crc32(bytes), 0xCBF43926U);
  EXPECT_EQ(crc32({}), 0U);
}

TEST(LivoxCommand, EncodesThePublishedFrames) {
  EXPECT_EQ(to_hex(encode_discovery(1)), "aa0018000100000000000000000000000000a91f00000000");
  EXPECT_EQ(
      to_hex(encode_set_hosts(2, {kHost, 56201, 56200}, {kHost, 56301, 56300}, {kHost, 56401, 56400})),
      "aa00400002000000000100000000000000008ec7cab502b50300000005000800c0a8010589db88db06000800c0a80105eddbec"
      "db07000800c0a8010551dc50dc");
  EXPECT_EQ(to_hex(encode_set_work_mode(3, WorkMode::kSampling)),
            "aa0021000300000000010000000000000000f7de6fd5e7ad010000001a00010001");
  EXPECT_EQ(to_hex(encode_set_point_type(4, 1)),
            "aa0021000400000000010000000000000000f1ae4c5ab787010000000000010001");
  EXPECT_EQ(to_hex(encode_set_imu(5, true)),
            "aa002100050000000001000000000000000090d5cf20a722010000001c00010001");
  EXPECT_EQ(to_hex(encode_set_gps_time(6, 1'700'000'000'000'000'000U)),
            "aa0021000600000002020000000000000000fdab44eeca6f0200002a36fe9c9717");
}

TEST(LivoxCommand, QueryListsItsKeys) {
  const std::array<Key, 2> keys{Key::kWorkState, Key::kSyncType};
  const auto bytes = encode_query(9, keys);
  const auto frame = decode_command(bytes);
  ASSERT_TRUE(frame.has_value()) << frame.error().context;
  EXPECT_EQ(frame->id, CommandId::kQueryParameters);
  EXPECT_EQ(frame->sequence, 9U);
  EXPECT_EQ(to_hex(frame->content), "0200000006800c80");
}

TEST(LivoxCommand, DecodesADiscoveryAnswer) {
  const auto content = from_hex(
      "0009"
      "3437"
      "4d4c"
      "3132"
      "3334"
      "3536"
      "3738"
      "0000"
      "0000"
      "c0a80164"
      "24db");
  const auto bytes = lidar_frame(CommandId::kDiscovery, true, content);
  const auto frame = decode_command(bytes);
  ASSERT_TRUE(frame.has_value()) << frame.error().context;
  const auto lidar = decode_discovery_ack(*frame);
  ASSERT_TRUE(lidar.has_value()) << lidar.error().context;
  EXPECT_EQ(lidar->device_type, 9);
  EXPECT_EQ(lidar->serial_number, "47ML12345678");
  EXPECT_EQ(lidar->ip, (Ipv4{192, 168, 1, 100}));
  EXPECT_EQ(lidar->command_port, 56100);
  for (std::size_t length = 0; length < content.size(); ++length) {
    const CommandFrame cut{1, CommandId::kDiscovery, true, true, std::span(content).first(length)};
    EXPECT_EQ(decode_discovery_ack(cut).error().code, Errc::kBadPacket) << length;
  }
}

TEST(LivoxCommand, DecodesSetAndQueryAnswers) {
  const auto set = from_hex("031a00");
  const auto set_bytes = lidar_frame(CommandId::kSetParameters, true, set);
  const auto set_reply = decode_parameter_reply(*decode_command(set_bytes));
  ASSERT_TRUE(set_reply.has_value());
  EXPECT_EQ(describe_return_code(set_reply->return_code), "value out of range");
  EXPECT_EQ(set_reply->error_key, 0x1A);

  const auto query = from_hex(
      "00"
      "0200"
      "0680"
      "0100"
      "01"
      "0780"
      "0400"
      "b80b0000");
  const auto query_bytes = lidar_frame(CommandId::kQueryParameters, true, query);
  const auto reply = decode_parameter_reply(*decode_command(query_bytes));
  ASSERT_TRUE(reply.has_value()) << reply.error().context;
  ASSERT_EQ(reply->parameters.size(), 2U);
  EXPECT_EQ(reply->parameters[0].key, Key::kWorkState);
  EXPECT_EQ(to_hex(reply->parameters[1].value), "b80b0000");
}

TEST(LivoxCommand, RefusesListsThatEndEarly) {
  const auto whole = from_hex(
      "0200"
      "0000"
      "0680"
      "0100"
      "01"
      "0c80"
      "0100"
      "01");
  const CommandFrame good{1, CommandId::kStatePush, false, true, whole};
  ASSERT_EQ(decode_state_push(good)->size(), 2U);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const CommandFrame cut{1, CommandId::kStatePush, false, true, std::span(whole).first(length)};
    EXPECT_EQ(decode_state_push(cut).error().code, Errc::kBadPacket) << length;
  }
  for (const char* hostile : {"ffff"
                              "0000"
                              "0680"
                              "0100"
                              "01",
                              "0100"
                              "0000"
                              "0680"
                              "ffff"
                              "01"}) {
    const auto content = from_hex(hostile);
    const CommandFrame frame{1, CommandId::kStatePush, false, true, content};
    EXPECT_EQ(decode_state_push(frame).error().code, Errc::kBadPacket) << hostile;
  }
}

TEST(LivoxCommand, RefusesEveryFlippedBit) {
  const auto bytes = encode_set_work_mode(3, WorkMode::kSampling);
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    auto flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    const auto frame = decode_command(flipped);
    ASSERT_FALSE(frame.has_value()) << bit;
    EXPECT_EQ(frame.error().code, Errc::kBadPacket);
  }
}

TEST(LivoxCommand, RefusesOtherLengths) {
  auto bytes = encode_set_work_mode(3, WorkMode::kSampling);
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_FALSE(decode_command(std::span(bytes).first(length)).has_value()) << length;
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(decode_command(bytes).has_value());
  EXPECT_FALSE(
      decode_command(lidar_frame(CommandId::kStatePush, false, std::vector<std::byte>(1377))).has_value());
  EXPECT_TRUE(
      decode_command(lidar_frame(CommandId::kStatePush, false, std::vector<std::byte>(1376))).has_value());
}

}  // namespace
}  // namespace edgesplat::livox
