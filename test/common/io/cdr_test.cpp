// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/cdr.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace edgesplat::io {
namespace {

std::vector<std::byte> make_bytes(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

TEST(Cdr, AlignsFieldsFromAfterTheHeader) {
  CdrWriter writer;
  writer.write(std::uint8_t{1});
  writer.write(std::uint32_t{0x05040302});
  writer.write_string("hi");
  writer.write(std::uint16_t{7});
  EXPECT_EQ(writer.take(), make_bytes({0, 1, 0, 0,                  // little-endian CDR
                                       1, 0, 0, 0, 2,   3,   4, 5,  // u8, padding, u32
                                       3, 0, 0, 0, 'h', 'i', 0, 0, 7, 0}));
}

TEST(Cdr, ReadsWhatItWrote) {
  CdrWriter writer;
  const auto blob = make_bytes({9, 8, 7});
  writer.write(std::int8_t{-3});
  writer.write(1.5);
  writer.write_byte_sequence(blob);
  writer.write(2.5F);
  writer.write_string("");
  const auto bytes = writer.take();
  CdrReader reader(bytes);
  EXPECT_EQ(reader.read<std::int8_t>(), -3);
  EXPECT_EQ(reader.read<double>(), 1.5);
  const auto read_blob = reader.read_byte_sequence();
  EXPECT_EQ(std::vector<std::byte>(read_blob.begin(), read_blob.end()), blob);
  EXPECT_EQ(reader.read<float>(), 2.5F);
  EXPECT_EQ(reader.read_string(), "");
  EXPECT_TRUE(reader.ok());
  (void)reader.read<std::uint8_t>();
  EXPECT_FALSE(reader.ok());
}

TEST(Cdr, RefusesOtherEncapsulations) {
  for (const auto& bytes :
       {make_bytes({0, 0, 0, 0, 1}), make_bytes({0, 3, 0, 0, 1}), make_bytes({0, 1, 0}), make_bytes({})}) {
    CdrReader reader(bytes);
    EXPECT_EQ(reader.read<std::uint8_t>(), 0);
    EXPECT_FALSE(reader.ok());
  }
}

TEST(Cdr, AbsurdLengthsGiveNothing) {
  const auto bytes = make_bytes({0, 1, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 'a'});
  CdrReader strings(bytes);
  EXPECT_EQ(strings.read_string(), "");
  EXPECT_FALSE(strings.ok());
  CdrReader sequences(bytes);
  EXPECT_TRUE(sequences.read_byte_sequence().empty());
  EXPECT_FALSE(sequences.ok());
}

TEST(Cdr, StringWithoutItsZeroIsRefused) {
  const auto bytes = make_bytes({0, 1, 0, 0, 2, 0, 0, 0, 'a', 'b'});
  CdrReader reader(bytes);
  (void)reader.read_string();
  EXPECT_FALSE(reader.ok());
}

}  // namespace
}  // namespace edgesplat::io
