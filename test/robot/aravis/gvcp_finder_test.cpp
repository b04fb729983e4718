// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/gvcp_finder.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <string>
#include <vector>

namespace edgesplat::aravis {
namespace {

constexpr std::uint16_t kId = 0x0105;

void put_text(std::vector<std::byte>& answer, std::size_t at, const std::string& text) {
  std::memcpy(answer.data() + 8 + at, text.data(), text.size());
}

/// Offsets of the fields: GigE Vision's bootstrap registers.
std::vector<std::byte> good_answer() {
  std::vector<std::byte> answer(8 + 0xF8);
  answer[3] = std::byte{0x03};
  answer[5] = std::byte{0xF8};
  answer[6] = std::byte{0x01};
  answer[7] = std::byte{0x05};
  const std::uint8_t mac[] = {0x00, 0x30, 0x53, 0x11, 0x22, 0x33};
  std::memcpy(answer.data() + 8 + 0x0A, mac, sizeof(mac));
  const std::uint8_t address[] = {192, 168, 1, 77};
  std::memcpy(answer.data() + 8 + 0x24, address, sizeof(address));
  put_text(answer, 0x48, "Basler");
  put_text(answer, 0xD8, "21730412");
  return answer;
}

TEST(GvcpFinder, TheCommandIsTheStandardsAndHasItsId) {
  const auto command = discovery_command(0x0105);
  const std::uint8_t expected[] = {0x42, 0x11, 0x00, 0x02, 0x00, 0x00, 0x01, 0x05};
  EXPECT_EQ(std::memcmp(command.data(), expected, command.size()), 0);
}

TEST(GvcpFinder, AnAnswerTellsWhoAndWhere) {
  const auto camera = read_discovery_answer(good_answer(), kId);
  ASSERT_TRUE(camera.has_value());
  EXPECT_EQ(camera->address, "192.168.1.77");
  EXPECT_EQ(camera->mac, 0x003053112233U);
  EXPECT_EQ(camera->maker, "Basler");
  EXPECT_EQ(camera->serial_number, "21730412");
}

TEST(GvcpFinder, TextThatFillsItsFieldEndsThereAndWhatIsNotPrintableIsReplaced) {
  auto answer = good_answer();
  put_text(answer, 0xD8, "0123456789ABCDEF");
  put_text(answer, 0xE8, "user's name");
  put_text(answer, 0x48, "a\nb\xFF");
  const auto camera = read_discovery_answer(answer, kId);
  ASSERT_TRUE(camera.has_value());
  EXPECT_EQ(camera->serial_number, "0123456789ABCDEF");
  EXPECT_EQ(camera->maker, "a?b?er");
}

TEST(GvcpFinder, OnlyAWholeAnswerToThatQuestionCounts) {
  const auto good = good_answer();
  for (std::size_t i = 0; i < 8; ++i) {
    auto bad = good;
    bad[i] ^= std::byte{1};
    EXPECT_FALSE(read_discovery_answer(bad, kId).has_value()) << i;
  }
  for (std::size_t bytes = 0; bytes < good.size(); ++bytes)
    EXPECT_FALSE(read_discovery_answer(std::span(good).first(bytes), kId).has_value()) << bytes;
  auto longer = good;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(read_discovery_answer(longer, kId).has_value());
}

TEST(GvcpFinder, ACameraIsItsMakerAndSerialNumberOrWithoutItsNetworkCard) {
  const FoundCamera camera{"10.0.0.1", 1, "A", "7"};
  EXPECT_TRUE(is_same_camera(camera, {"10.0.0.9", 2, "A", "7"}));
  EXPECT_FALSE(is_same_camera(camera, {"10.0.0.1", 1, "A", "8"}));
  EXPECT_FALSE(is_same_camera(camera, {"10.0.0.1", 1, "B", "7"}));
  EXPECT_TRUE(is_same_camera({"10.0.0.1", 1, "A", ""}, {"10.0.0.2", 1, "A", ""}));
  EXPECT_FALSE(is_same_camera({"10.0.0.1", 1, "A", ""}, {"10.0.0.1", 2, "A", ""}));
}

TEST(GvcpFinder, NobodyThereIsNoWithinTheTimeout) {
  GvcpFinder finder;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(finder.ask("127.251.251.251", {}, std::chrono::milliseconds(50)).has_value());
  EXPECT_FALSE(finder.ask("127.251.251.251", {}, std::chrono::milliseconds(50)).has_value())
      << "the refusal of the first is no answer either";
  EXPECT_FALSE(finder.find([](const FoundCamera&) { return false; }, {}, std::chrono::milliseconds(50)));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
}

TEST(GvcpFinder, AStopEndsTheWaiting) {
  GvcpFinder finder;
  std::stop_source stop;
  stop.request_stop();
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(finder.find([](const FoundCamera&) { return true; }, stop.get_token(), std::chrono::hours(1)));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(GvcpFinder, ANameIsNoAddress) {
  EXPECT_FALSE(GvcpFinder().ask("front camera", {}, std::chrono::milliseconds(1)).has_value());
}

}  // namespace
}  // namespace edgesplat::aravis
