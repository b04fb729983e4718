// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/sdk1_command.hpp"

#include "robot/drivers/livox/checksum.hpp"
#include "robot/drivers/livox/utc_date.hpp"
#include "test/robot/livox/hex.hpp"
#include "test/robot/livox/sdk1_bytes.hpp"

#include <gtest/gtest.h>

#include <string>

namespace edgesplat::livox {
namespace {

TEST(Sdk1Checksum, GivesThePublishedCheckValues) {
  const std::string digits = "123456789";
  const auto bytes = std::as_bytes(std::span(digits.data(), digits.size()));
  EXPECT_EQ(sdk1_crc16(bytes), 0xAB4E);
  EXPECT_EQ(sdk1_crc32(bytes), 0xB08DB5B1U);
  // Over a header with its own checksum nothing is left.
  EXPECT_EQ(sdk1_crc16(from_hex("aa010f0000000004d7")), 0);
}

TEST(Sdk1Command, EncodesThePublishedFrames) {
  EXPECT_EQ(to_hex(encode_sdk1_request(0, Sdk1Command::kHeartbeat)), "aa010f0000000004d7000338ba8d0c");
  EXPECT_EQ(to_hex(encode_sdk1_request(1, Sdk1Command::kHeartbeat)), "aa010f00000100dcce00031460c637");
  EXPECT_EQ(to_hex(encode_sdk1_handshake(0, {{192, 168, 1, 33}, 50002, 50001, 50002})),
            "aa011900000000dc580001c0a8012152c351c352c363925b8b");
  EXPECT_EQ(to_hex(encode_sdk1_handshake(1, {{192, 168, 1, 50}, 56001, 55501, 56001})),
            "aa01190000010004410001c0a80132c1dacdd8c1da50e156f8");
  EXPECT_EQ(to_hex(encode_sdk1_request(2, Sdk1Command::kSampling, 1)), "aa011000000200083a00040150c39562");
  EXPECT_EQ(to_hex(encode_sdk1_request(3, Sdk1Command::kSampling, 0)), "aa011000000300d023000400ffd47127");
  EXPECT_EQ(to_hex(encode_sdk1_request(4, Sdk1Command::kCoordinate, 0)), "aa011000000400d86e0005001110c3a2");
  EXPECT_EQ(
      to_hex(encode_sdk1_request(5, Sdk1Command::kReturnMode, static_cast<std::uint8_t>(ReturnMode::kFirst))),
      "aa0110000005000077010600dc0ecfba");
  EXPECT_EQ(to_hex(encode_sdk1_request(6, Sdk1Command::kImuRate, 1)), "aa011000000600685d0108018f7a6e04");
  const auto three_o_clock = to_unix_ns({2026, 11, 22, 3, 1'500'000});
  ASSERT_TRUE(three_o_clock.has_value());
  EXPECT_EQ(to_hex(encode_sdk1_utc(7, *three_o_clock)), "aa0117000007006c74010a1a0b160360e31600d3c4b4b0");
}

TEST(Sdk1Command, DecodesWhatALidarSays) {
  const auto announcement_bytes = sdk1_frame(0x0000, 2,
                                             from_hex("3047"
                                                      "4d4c"
                                                      "3132"
                                                      "3334"
                                                      "3536"
                                                      "3738"
                                                      "3931"
                                                      "0000"
                                                      "07"
                                                      "0000"));
  const auto frame = decode_sdk1(announcement_bytes);
  ASSERT_TRUE(frame.has_value()) << frame.error().context;
  const auto announcement = decode_sdk1_announcement(*frame);
  ASSERT_TRUE(announcement.has_value()) << announcement.error().context;
  EXPECT_EQ(announcement->serial_number, "0GML1234567891");
  EXPECT_EQ(announcement->device_type, 7);

  const auto heartbeat_bytes = sdk1_frame(0x0003, 1, from_hex("00010000420000"));
  const auto heartbeat = decode_sdk1_heartbeat(*decode_sdk1(heartbeat_bytes));
  ASSERT_TRUE(heartbeat.has_value()) << heartbeat.error().context;
  EXPECT_EQ(heartbeat->work_state, 1);
  EXPECT_EQ(heartbeat->status_or_progress, 0x4200U);

  const auto info_bytes = sdk1_frame(0x0002, 1, from_hex("000b060001"));
  const auto firmware = decode_sdk1_firmware(*decode_sdk1(info_bytes));
  ASSERT_TRUE(firmware.has_value());
  EXPECT_EQ((*firmware)[0], 11);
  EXPECT_EQ(decode_sdk1_return_code(*decode_sdk1(info_bytes)).value(), 0);

  const auto push_bytes = sdk1_frame(0x0007, 2, from_hex("00000080"));
  EXPECT_EQ(decode_sdk1_status_push(*decode_sdk1(push_bytes)).value(), 0x80000000U);
}

TEST(Sdk1Command, ReadsTheStatusWordFromItsLowEnd) {
  // temperature 1, voltage 2, motor 1, window 2 | pulse | PTP | time sync 2 | system 2
  const Sdk1Status status = read_sdk1_status(0b1U | 0b1000U | 0b1'0000U | 0b1000'0000U | 1U << 9U |
                                             1U << 13U | 2U << 14U | 2U << 30U);
  EXPECT_EQ(status.temperature, 1);
  EXPECT_EQ(status.voltage, 2);
  EXPECT_EQ(status.motor, 1);
  EXPECT_EQ(status.dirty_window, 2);
  EXPECT_TRUE(status.pulse_seen);
  EXPECT_TRUE(status.ptp_seen);
  EXPECT_EQ(status.time_sync, 2);
  EXPECT_EQ(status.system, 2);
}

TEST(Sdk1Command, RefusesContentThatEndsEarly) {
  const auto whole = from_hex("3047000000000000000000000000000007000000000000");
  for (std::size_t length = 0; length < 19; ++length) {
    const Sdk1Frame cut{Sdk1FrameType::kMessage, 1, Sdk1Command::kAnnouncement,
                        std::span(whole).first(length)};
    EXPECT_EQ(decode_sdk1_announcement(cut).error().code, Errc::kBadPacket) << length;
  }
  for (std::size_t length = 0; length < 7; ++length) {
    const Sdk1Frame cut{Sdk1FrameType::kAck, 1, Sdk1Command::kHeartbeat, std::span(whole).first(length)};
    EXPECT_EQ(decode_sdk1_heartbeat(cut).error().code, Errc::kBadPacket) << length;
  }
  for (std::size_t length = 0; length < 5; ++length) {
    const Sdk1Frame cut{Sdk1FrameType::kAck, 1, Sdk1Command::kDeviceInfo, std::span(whole).first(length)};
    EXPECT_EQ(decode_sdk1_firmware(cut).error().code, Errc::kBadPacket) << length;
  }
  const Sdk1Frame empty{Sdk1FrameType::kAck, 1, Sdk1Command::kSampling, {}};
  EXPECT_EQ(decode_sdk1_return_code(empty).error().code, Errc::kBadPacket);
}

TEST(Sdk1Command, RefusesEveryFlippedBitAndOtherLengths) {
  const auto bytes = encode_sdk1_request(2, Sdk1Command::kSampling, 1);
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    auto flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    ASSERT_FALSE(decode_sdk1(flipped).has_value()) << bit;
  }
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_FALSE(decode_sdk1(std::span(bytes).first(length)).has_value()) << length;
  auto longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(decode_sdk1(longer).has_value());
  EXPECT_TRUE(decode_sdk1(sdk1_frame(0x0007, 2, std::vector<std::byte>(1400 - 15))).has_value());
  EXPECT_FALSE(decode_sdk1(sdk1_frame(0x0007, 2, std::vector<std::byte>(1401 - 15))).has_value());
  EXPECT_FALSE(decode_sdk1(sdk1_frame(0x0007, 3, from_hex("00000000"))).has_value());
}

TEST(UtcDate, AgreesWithKnownMomentsBothWays) {
  EXPECT_EQ(to_unix_ns({2023, 11, 14, 22, 800'000'000}), 1'700'000'000'000'000'000);
  EXPECT_EQ(to_unix_ns({2000, 2, 29, 0, 0}), 951'782'400'000'000'000);
  for (const std::int64_t ns : {0LL, 951'782'400'000'000'000LL, 1'700'000'000'123'456'000LL})
    EXPECT_EQ(to_unix_ns(to_utc_date(ns)), ns);
  EXPECT_FALSE(to_unix_ns({2023, 2, 29, 0, 0}).has_value());
  EXPECT_FALSE(to_unix_ns({2023, 13, 1, 0, 0}).has_value());
  EXPECT_FALSE(to_unix_ns({2023, 0, 1, 0, 0}).has_value());
  EXPECT_FALSE(to_unix_ns({2023, 1, 1, 24, 0}).has_value());
  EXPECT_FALSE(to_unix_ns({2023, 1, 1, 0, 3'600'000'000U}).has_value());
}

}  // namespace
}  // namespace edgesplat::livox
