// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The virtual GigE Vision camera without sockets: bytes against the layouts of the standard.
#include "tools/virtual_device/gige_device.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace edgesplat::virtual_device {
namespace {

using Bytes = std::vector<std::byte>;

Bytes hex(const std::string& text) {
  Bytes out;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    out.push_back(static_cast<std::byte>(std::stoi(text.substr(i, 2), nullptr, 16)));
  return out;
}

constexpr GigePeer kHost{0x7F000001, 50'000}, kOther{0x7F000001, 50'001};
const HostTime kNow = host_time_from_ns(1'000'000'000);

class GigeProtocol : public testing::Test {
 protected:
  Bytes ask(const std::string& command, GigePeer from = kHost, HostTime now = kNow) {
    return device_.on_datagram(hex(command), from, now);
  }
  /// WRITEREG of one register; the answer's status.
  std::string write(const std::string& address, const std::string& value, GigePeer from = kHost,
                    HostTime now = kNow) {
    const Bytes answer =
        ask("420100820008"
            "0011" +
                address + value,
            from, now);
    EXPECT_GE(answer.size(), 8U);
    return answer.size() < 2 ? ""
                             : std::to_string(std::to_integer<int>(answer[0])) + "." +
                                   std::to_string(std::to_integer<int>(answer[1]));
  }
  GigeExposure exposure() const {
    return {std::make_shared<const sensor::ImageRgb8>(8, 4, std::uint8_t{7}),
            sensor_time_from_ns(0x1122334455667788), 5000.0F, 0.0F};
  }
  void start() {
    EXPECT_EQ(write("00000a00", "00000002"), "0.0");
    EXPECT_EQ(write("00000d18", "7f000001"), "0.0");
    EXPECT_EQ(write("00000d00", "0000c351"), "0.0");
    EXPECT_EQ(write("00010010", "00000001"), "0.0");
  }
  GigeDevice device_{{.width_px = 8, .height_px = 4, .serial = "X1"}};
};

TEST_F(GigeProtocol, DiscoveryAnswersWithTheBootstrapRegisters) {
  const Bytes answer = ask("4211000200000007");
  ASSERT_EQ(answer.size(), 8U + 0xF8U);
  EXPECT_EQ(Bytes(answer.begin(), answer.begin() + 8), hex("0000000300f80007"));
  const std::string vendor(reinterpret_cast<const char*>(answer.data()) + 8 + 0x48);
  EXPECT_EQ(vendor, "edgesplat");
  const std::string serial(reinterpret_cast<const char*>(answer.data()) + 8 + 0xD8);
  EXPECT_EQ(serial, "X1");
}

TEST_F(GigeProtocol, RegistersAndMemoryAreRead) {
  EXPECT_EQ(ask("4201008000040005"
                "00000938"),
            hex("0000008100040005"
                "00000bb8"));
  EXPECT_EQ(ask("4201008000080006"
                "00010000"
                "00010004"),
            hex("0000008100080006"
                "00000008"
                "00000004"));
  EXPECT_EQ(ask("4201008400080007"
                "00000d04"
                "00000004"),
            hex("0000008500080007"
                "00000d04"
                "000005dc"));
}

TEST_F(GigeProtocol, ErrorsNameTheirReason) {
  EXPECT_EQ(ask("4201008000040005"
                "00000939"),
            hex("8005008100000005"));
  EXPECT_EQ(ask("4201008000040005"
                "7ffffff0"),
            hex("8003008100000005"));
  EXPECT_EQ(ask("4201009900000005"), hex("8001009a00000005"));
  EXPECT_EQ(ask("4201008000060005"
                "00000938"
                "0000"),
            hex("8002008100000005"));
  EXPECT_EQ(write("00010000", "00000001"), "128.6");  // nobody has control
  EXPECT_EQ(write("00000a00", "00000002"), "0.0");
  EXPECT_EQ(write("00010000", "00000001"), "128.4");  // Width is read only
  EXPECT_EQ(write("00010008", "01100003"), "128.2");  // Mono10
  EXPECT_EQ(write("00010008", "01080009", kOther), "128.6");
  EXPECT_EQ(write("00000a00", "00000002", kOther), "128.6");
}

TEST_F(GigeProtocol, ASilentHostLosesControl) {
  start();
  device_.tick(kNow + std::chrono::milliseconds(2900));
  EXPECT_TRUE(device_.acquiring());
  (void)ask(
      "4201008000040005"
      "00000a00",
      kHost, kNow + std::chrono::milliseconds(2900));
  device_.tick(kNow + std::chrono::milliseconds(5800));
  EXPECT_TRUE(device_.controlled());
  device_.tick(kNow + std::chrono::milliseconds(6000));
  EXPECT_FALSE(device_.controlled());
  EXPECT_FALSE(device_.acquiring());
  EXPECT_EQ(device_.control_losses(), 1U);
  EXPECT_EQ(write("00000a00", "00000002", kOther), "0.0");
}

TEST_F(GigeProtocol, TriggerModeDecidesWhichPulsesBecomeFrames) {
  EXPECT_EQ(device_.expose(exposure()), nullptr);  // nobody listens
  start();
  EXPECT_NE(device_.expose(exposure()), nullptr);  // free running
  EXPECT_EQ(write("00010040", "00000001"), "0.0");
  EXPECT_NE(device_.expose(exposure()), nullptr);  // on Line0
  EXPECT_EQ(write("00010044", "00000001"), "0.0");
  EXPECT_EQ(device_.expose(exposure()), nullptr);  // by software only
  EXPECT_EQ(device_.take_triggered_frame(), nullptr);
  EXPECT_EQ(write("00010034", "00000001"), "0.0");
  const auto frame = device_.take_triggered_frame();
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->number, 3U);
  EXPECT_EQ(device_.take_triggered_frame(), nullptr);
}

TEST_F(GigeProtocol, PacketsHaveTheStandardsLayout) {
  start();
  const auto frame = device_.expose(exposure());
  ASSERT_NE(frame, nullptr);
  ASSERT_EQ(frame->payload.size(), 32U);
  const std::uint32_t packet_bytes = 36 + 20;  // two payload packets
  ASSERT_EQ(gvsp_packet_count(32, packet_bytes), 4U);
  Bytes packet;
  encode_gvsp_packet(*frame, 0, packet_bytes, GvspStatus::kFirst, packet);
  EXPECT_EQ(packet, hex("0000000101000000"
                        "00000001"
                        "1122334455667788"
                        "01080001"
                        "00000008"
                        "00000004"
                        "00000000"
                        "00000000"
                        "00000000"));
  encode_gvsp_packet(*frame, 2, packet_bytes, GvspStatus::kResent, packet);
  EXPECT_EQ(packet, hex("0100000103000002"
                        "070707070707070707070707"));
  encode_gvsp_packet(*frame, 3, packet_bytes, GvspStatus::kFirst, packet);
  EXPECT_EQ(packet, hex("0000000102000003"
                        "00000001"
                        "00000004"));
  EXPECT_EQ(gvsp_unavailable(9, 5), hex("800c000903000005"));
}

TEST_F(GigeProtocol, ChunksFollowThePixelsEachWithItsIdAndLengthBehind) {
  start();
  EXPECT_EQ(write("00010080", "00000001"), "0.0");  // ChunkModeActive
  EXPECT_EQ(write("00010084", "00000001"), "0.0");  // ChunkEnable of Timestamp
  EXPECT_EQ(device_.registers().value(gige_register::kPayloadBytes), 32U + 8U + 16U);
  const auto frame = device_.expose(exposure());
  ASSERT_NE(frame, nullptr);
  ASSERT_EQ(frame->payload.size(), 56U);
  EXPECT_EQ(Bytes(frame->payload.begin() + 32, frame->payload.end()), hex("a0000001"
                                                                          "00000020"
                                                                          "1122334455667788"
                                                                          "a0000010"
                                                                          "00000008"));
  Bytes leader;
  encode_gvsp_packet(*frame, 0, 1500, GvspStatus::kFirst, leader);
  EXPECT_EQ(Bytes(leader.begin() + 8, leader.begin() + 12), hex("00004001"));
}

TEST_F(GigeProtocol, ResendRequestsAreRememberedAndFramesKeptForThem) {
  start();
  for (int i = 0; i < 6; ++i) (void)device_.expose(exposure());
  EXPECT_TRUE(ask("420000400000000900000003").empty());  // wrong length
  EXPECT_FALSE(device_.take_resend().has_value());
  EXPECT_TRUE(ask("42000040000c0009"
                  "00000004"
                  "00000001"
                  "00000002")
                  .empty());
  const auto wanted = device_.take_resend();
  ASSERT_TRUE(wanted.has_value());
  EXPECT_EQ(wanted->frame, 4U);
  EXPECT_EQ(wanted->first_packet, 1U);
  EXPECT_EQ(wanted->last_packet, 2U);
  EXPECT_EQ(device_.find_frame(2), nullptr);
  EXPECT_NE(device_.find_frame(3), nullptr);
}

TEST_F(GigeProtocol, DamagedCommandsGetNoAnswerOrAnErrorAndChangeNothing) {
  EXPECT_TRUE(ask("").empty());
  EXPECT_TRUE(ask("42").empty());
  EXPECT_TRUE(ask("43010080000400050000093800000000").empty());
  EXPECT_TRUE(ask("420100800004000000000938").empty());  // id 0
  const Bytes good =
      hex("4201008200080011"
          "00000a00"
          "00000002");
  for (std::size_t length = 0; length < good.size(); ++length) {
    const Bytes answer = device_.on_datagram(std::span(good).first(length), kHost, kNow);
    if (!answer.empty()) {
      EXPECT_EQ(answer[0], std::byte{0x80}) << length;
    }
  }
  EXPECT_FALSE(device_.controlled());
}

}  // namespace
}  // namespace edgesplat::virtual_device
