// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/frame_socket/frame_assembler.hpp"

#include "test/robot/frame_socket/frame_bytes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace edgesplat::frame_socket {
namespace {

std::vector<std::byte> payload_of(std::size_t bytes, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::vector<std::byte> payload(bytes);
  for (std::byte& byte : payload) byte = static_cast<std::byte>(random() & 0xFFU);
  return payload;
}

std::vector<std::byte> stream_of(std::uint32_t messages) {
  std::vector<std::byte> stream;
  for (std::uint32_t i = 0; i < messages; ++i) {
    MessageFields fields;
    fields.sequence = i;
    const auto message = message_bytes(fields, payload_of(100 + 37 * i, i));
    stream.insert(stream.end(), message.begin(), message.end());
  }
  return stream;
}

std::vector<std::uint32_t> sequences(FrameAssembler& assembler) {
  std::vector<std::uint32_t> all;
  while (const auto frame = assembler.next()) all.push_back(frame->header.sequence);
  return all;
}

TEST(FrameAssembler, ReadsEveryFieldAtItsOffset) {
  const auto payload = payload_of(10);
  MessageFields fields;
  fields.sequence = 0x01020304;
  fields.stamp_ns = -5;
  const auto bytes = message_bytes(fields, payload);
  ASSERT_EQ(bytes.size(), 58U);
  EXPECT_EQ(bytes[12], std::byte{4});  // little-endian sequence at 12
  const auto header = decode_header(bytes);
  ASSERT_TRUE(header.has_value()) << header.error().context;
  EXPECT_EQ(header->payload_bytes, 10U);
  EXPECT_EQ(header->sequence, 0x01020304U);
  EXPECT_EQ(to_ns(header->stamp), -5);
  EXPECT_FLOAT_EQ(header->exposure_s, 0.005F);
  EXPECT_FLOAT_EQ(header->gain_db, 3.0F);
  EXPECT_EQ(header->stamp_source, sensor::StampSource::kPtp);
  EXPECT_EQ(header->format, PictureFormat::kPng);
  EXPECT_EQ(header->width_px, 4);
  EXPECT_EQ(header->height_px, 3);
}

TEST(FrameAssembler, RefusesFieldsOutOfRange) {
  const auto payload = payload_of(10);
  std::vector<MessageFields> wrong(11);
  wrong[0].version = 2;
  wrong[1].header_bytes = 44;
  wrong[2].payload_bytes = 0;
  wrong[3].payload_bytes = std::int64_t{kMaxPayloadBytes} + 1;
  wrong[4].stamp_source = 3;
  wrong[5].format = 0;
  wrong[6].width = 0;
  wrong[7].height = 0;
  wrong[8].exposure_s = std::numeric_limits<float>::quiet_NaN();
  wrong[9].stamp_ns = std::numeric_limits<std::int64_t>::max();
  wrong[10].exposure_s = -1.0F;
  for (std::size_t i = 0; i < wrong.size(); ++i)
    EXPECT_EQ(decode_header(message_bytes(wrong[i], payload)).error().code, Errc::kBadPacket) << i;
}

TEST(FrameAssembler, RefusesEveryFlippedBitOfTheHeader) {
  const auto bytes = message_bytes({}, payload_of(10));
  for (std::size_t bit = 0; bit < kHeaderBytes * 8; ++bit) {
    auto flipped = bytes;
    flipped[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    EXPECT_FALSE(decode_header(flipped).has_value()) << bit;
  }
  for (std::size_t length = 0; length < kHeaderBytes; ++length)
    EXPECT_FALSE(decode_header(std::span(bytes).first(length)).has_value()) << length;
}

TEST(FrameAssembler, JoinsReadsOfAnySize) {
  const auto stream = stream_of(5);
  for (const std::size_t step :
       {std::size_t{1}, std::size_t{7}, std::size_t{48}, std::size_t{200}, stream.size()}) {
    FrameAssembler assembler;
    std::vector<std::uint32_t> got;
    for (std::size_t at = 0; at < stream.size(); at += step) {
      assembler.append(std::span(stream).subspan(at, std::min(step, stream.size() - at)));
      for (const std::uint32_t sequence : sequences(assembler)) got.push_back(sequence);
    }
    EXPECT_EQ(got, (std::vector<std::uint32_t>{0, 1, 2, 3, 4})) << step;
    EXPECT_EQ(assembler.counters().bytes_skipped, 0U);
  }
}

TEST(FrameAssembler, FindsTheNextMessageAfterDamage) {
  auto stream = stream_of(4);
  stream[60] ^= std::byte{1};       // picture of message 0
  stream[148 + 5] ^= std::byte{1};  // header of message 1
  FrameAssembler assembler;
  assembler.append(stream);
  EXPECT_EQ(sequences(assembler), (std::vector<std::uint32_t>{2, 3}));
  EXPECT_EQ(assembler.counters().bad_payloads, 1U);
  EXPECT_EQ(assembler.counters().bad_headers, 1U);
  EXPECT_EQ(assembler.counters().bytes_skipped, 148U + 185U);
}

TEST(FrameAssembler, FindsTheMessageThatBeganWhereBytesWereLost) {
  auto stream = stream_of(3);
  stream.erase(stream.begin() + 70, stream.begin() + 90);  // 20 bytes of message 0
  FrameAssembler assembler;
  assembler.append(stream);
  EXPECT_EQ(sequences(assembler), (std::vector<std::uint32_t>{1, 2}));
}

TEST(FrameAssembler, RandomBytesAndFlipsGiveOnlyWholePictures) {
  const auto good = stream_of(6);
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    auto stream = good;
    for (int i = 0; i < 4; ++i)
      stream[random() % stream.size()] ^= static_cast<std::byte>(1U << (random() % 8));
    FrameAssembler assembler;
    assembler.append(payload_of(random() % 300, seed));
    (void)sequences(assembler);
    assembler.append(stream);
    while (const auto frame = assembler.next())
      EXPECT_EQ(frame->payload, payload_of(100 + 37 * frame->header.sequence, frame->header.sequence));
  }
}

TEST(FrameAssembler, RestartForgetsTheOldConnection) {
  const auto stream = stream_of(1);
  FrameAssembler assembler;
  assembler.append(std::span(stream).first(100));
  EXPECT_FALSE(assembler.next().has_value());
  assembler.restart();
  assembler.append(stream);
  EXPECT_EQ(sequences(assembler), std::vector<std::uint32_t>{0});
  EXPECT_EQ(assembler.counters().bytes_skipped, 0U);
}

}  // namespace
}  // namespace edgesplat::frame_socket
