// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace edgesplat {
namespace {

TEST(ByteReader, ReadsLittleEndianFieldsInOrder) {
  ByteWriter writer;
  writer.write<std::uint8_t>(0x12);
  writer.write<std::uint32_t>(0xdeadbeef);
  writer.write<std::int16_t>(-2);
  writer.write<double>(-0.125);
  EXPECT_EQ(writer.bytes()[1], std::byte{0xef});
  ByteReader reader(writer.bytes());
  EXPECT_EQ(reader.read<std::uint8_t>(), 0x12);
  EXPECT_EQ(reader.read<std::uint32_t>(), 0xdeadbeefU);
  EXPECT_EQ(reader.read<std::int16_t>(), -2);
  EXPECT_EQ(reader.read<double>(), -0.125);
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader.remaining(), 0U);
}

TEST(ByteReader, EveryTruncationFailsForGood) {
  ByteWriter writer;
  writer.write<std::uint32_t>(1);
  writer.write<std::uint64_t>(2);
  for (std::size_t length = 0; length < writer.size(); ++length) {
    ByteReader reader(writer.bytes().first(length));
    (void)reader.read<std::uint32_t>();
    EXPECT_EQ(reader.read<std::uint64_t>(), 0U);
    EXPECT_FALSE(reader.ok());
    EXPECT_EQ(reader.remaining(), 0U);
    EXPECT_EQ(reader.read<std::uint8_t>(), 0U) << "a read after a failure must not find bytes again";
  }
}

TEST(ByteReader, TakeChecksAbsurdLengths) {
  const std::array<std::byte, 4> bytes{};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.take(4).size(), 4U);
  EXPECT_TRUE(reader.ok());
  EXPECT_TRUE(reader.take(0).empty());
  EXPECT_TRUE(reader.ok());
  ByteReader hostile(bytes);
  (void)hostile.read<std::uint8_t>();
  EXPECT_TRUE(hostile.take(std::numeric_limits<std::size_t>::max()).empty());
  EXPECT_FALSE(hostile.ok());
  ByteReader skipped(bytes);
  skipped.skip(5);
  EXPECT_FALSE(skipped.ok());
}

TEST(ByteReader, AnEmptyInputIsFineUntilItIsRead) {
  ByteReader reader({});
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader.read<float>(), 0.0F);
  EXPECT_FALSE(reader.ok());
}

TEST(ByteWriter, PatchesAFieldWrittenEarlier) {
  ByteWriter writer;
  writer.write<std::uint16_t>(0);
  writer.write_text("body");
  writer.patch<std::uint16_t>(0, static_cast<std::uint16_t>(writer.size()));
  ByteReader reader(writer.bytes());
  EXPECT_EQ(reader.read<std::uint16_t>(), 6);
}

TEST(ByteWriterDeathTest, PatchOutsideIsABug) {
  ByteWriter writer;
  writer.write<std::uint16_t>(0);
  EXPECT_DEATH(writer.patch<std::uint32_t>(0, 1), "patch");
  EXPECT_DEATH(writer.patch<std::uint8_t>(std::numeric_limits<std::size_t>::max(), 1), "patch");
}

}  // namespace
}  // namespace edgesplat
