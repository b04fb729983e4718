// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/serial_imu/serial_protocol.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string_view>

namespace edgesplat::serial_imu {
namespace {

std::vector<std::byte> bytes_of(std::initializer_list<unsigned> values) {
  std::vector<std::byte> out;
  for (const unsigned value : values) out.push_back(static_cast<std::byte>(value));
  return out;
}

InertialFrame sample(std::uint16_t sequence) {
  return {sequence,
          sensor_time_from_ns(1'000'000 + sequence * 5'000'000LL),
          {0.5F, -0.25F, 2.0F},
          {0.0F, 0.0F, 9.75F}};
}

TEST(SerialProtocol, TheChecksumIsThePublishedOne) {
  const std::string_view digits = "123456789";
  EXPECT_EQ(crc16_ccitt(std::as_bytes(std::span(digits.data(), digits.size()))), 0x29B1);
}

TEST(SerialProtocol, FramesHaveTheDocumentedLayout) {
  const auto pulse = encode(PulseFrame{0x0102, 0x0A0B0C0D, 0x1122334455667788});
  auto wanted = bytes_of({0xA5, 0x5A, 2, 16,   0x02, 0x01, 0x0D, 0x0C, 0x0B, 0x0A, 0,
                          0,    0,    0, 0x88, 0x77, 0x66, 0x55, 0x44, 0x33, 0x22, 0x11});
  const std::uint16_t crc = crc16_ccitt(std::span(wanted).subspan(2));
  wanted.push_back(static_cast<std::byte>(crc & 0xFFU));
  wanted.push_back(static_cast<std::byte>(crc >> 8U));
  EXPECT_EQ(pulse, wanted);
  const auto inertial = encode(sample(7));
  ASSERT_EQ(inertial.size(), kHeaderBytes + kSampleBytes + kChecksumBytes);
  EXPECT_EQ(std::vector(inertial.begin() + 14, inertial.begin() + 18), bytes_of({0, 0, 0, 0x3F}));  // 0.5
}

TEST(SerialProtocol, AnyReadsGiveTheSameFrames) {
  std::vector<std::byte> stream;
  for (std::uint16_t i = 0; i < 50; ++i) {
    const auto frame = i % 5 == 4 ? encode(PulseFrame{i, i, i}) : encode(sample(i));
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  for (const std::size_t step : {std::size_t{1}, std::size_t{3}, std::size_t{41}, stream.size()}) {
    FrameDecoder decoder;
    int inertial = 0, pulses = 0;
    for (std::size_t at = 0; at < stream.size(); at += step) {
      decoder.append(std::span(stream).subspan(at, std::min(step, stream.size() - at)));
      while (const auto frame = decoder.next())
        ++(std::holds_alternative<InertialFrame>(*frame) ? inertial : pulses);
    }
    EXPECT_EQ(inertial, 40) << step;
    EXPECT_EQ(pulses, 10) << step;
    EXPECT_EQ(decoder.counters().bytes_skipped, 0U) << step;
  }
}

TEST(SerialProtocol, EveryFlippedBitCostsOneFrameOnly) {
  const auto before = encode(sample(1)), frame = encode(sample(2)), after = encode(sample(3));
  for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
    auto bad = frame;
    bad[bit / 8] ^= std::byte{1} << (bit % 8);
    FrameDecoder decoder;
    for (const auto& part : {before, bad, after, encode(sample(4)), encode(sample(5)), encode(sample(6)),
                             encode(sample(7)), encode(sample(8)), encode(sample(9))})
      decoder.append(part);
    std::vector<std::uint16_t> seen;
    while (const auto next = decoder.next()) seen.push_back(std::get<InertialFrame>(*next).sequence);
    EXPECT_EQ(std::ranges::count(seen, 2), 0) << bit;
    EXPECT_EQ(seen.size(), 8U) << bit;
  }
}

TEST(SerialProtocol, NoiseIsSkippedAndCounted) {
  std::mt19937 random(3);
  FrameDecoder decoder;
  std::uint64_t noise = 0;
  int seen = 0;
  for (std::uint16_t i = 0; i < 200; ++i) {
    std::vector<std::byte> junk(random() % 30);
    for (auto& byte : junk) byte = static_cast<std::byte>(random() % 0xA0);  // no beginning of a frame
    noise += junk.size();
    decoder.append(junk);
    decoder.append(encode(sample(i)));
    while (decoder.next()) ++seen;
  }
  EXPECT_EQ(seen, 200);
  EXPECT_EQ(decoder.counters().bytes_skipped, noise);
}

TEST(SerialProtocol, AnUnknownTypeIsCountedAndPassedOver) {
  auto other = encode(PulseFrame{1, 2, 3});
  other[2] = std::byte{9};
  const std::uint16_t crc = crc16_ccitt(std::span(other).subspan(2, other.size() - 4));
  other[other.size() - 2] = static_cast<std::byte>(crc & 0xFFU);
  other[other.size() - 1] = static_cast<std::byte>(crc >> 8U);
  FrameDecoder decoder;
  decoder.append(other);
  decoder.append(encode(sample(5)));
  EXPECT_TRUE(decoder.next().has_value());
  EXPECT_EQ(decoder.counters().unknown, 1U);
}

}  // namespace
}  // namespace edgesplat::serial_imu
