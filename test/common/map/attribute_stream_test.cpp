// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/attribute_stream.hpp"

#include "common/map/varint.hpp"
#include "test/support/random.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace edgesplat::map {
namespace {

std::vector<std::uint16_t> numbers(std::size_t count, const std::function<std::uint32_t(std::size_t)>& of) {
  std::vector<std::uint16_t> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<std::uint16_t>(of(i));
  return values;
}

std::size_t round_trip(const std::vector<std::uint16_t>& values, std::size_t columns, unsigned bits,
                       Values kind) {
  ByteWriter out;
  AttributeWriter(out).integers(values, columns, bits, kind);
  ByteReader in(out.bytes());
  const auto back = AttributeReader(in).integers(values.size() / columns, columns, bits);
  EXPECT_TRUE(back && *back == values);
  EXPECT_EQ(in.remaining(), 0U);
  return out.size();
}

TEST(AttributeStream, IntegersOfEveryWidthComeBack) {
  test::Random random(1);
  for (unsigned bits = 1; bits <= 16; ++bits) {
    for (const Values kind : {Values::kAbsolute, Values::kDifferences}) {
      for (const std::size_t rows : {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{1000}})
        (void)round_trip(
            numbers(3 * rows,
                    [&](std::size_t) { return static_cast<std::uint32_t>(random.below(1U << bits)); }),
            3, bits, kind);
    }
  }
}

TEST(AttributeStream, TakesTheFormThatIsShortest) {
  constexpr std::size_t kCount = 3000;
  test::Random random(1);
  const auto any = [&](std::size_t) { return static_cast<std::uint32_t>(random.below(65536)); };
  const auto slope = [](std::size_t i) { return static_cast<std::uint32_t>(20 * i); };
  const auto around_zero = [&](std::size_t) { return static_cast<std::uint32_t>(random.below(9)) - 4U; };
  EXPECT_LT(round_trip(numbers(kCount, any), 1, 16, Values::kAbsolute), 2 * kCount + 20);
  EXPECT_LT(round_trip(numbers(kCount, slope), 1, 16, Values::kAbsolute), kCount / 10);
  EXPECT_LT(round_trip(numbers(kCount, around_zero), 1, 16, Values::kDifferences), kCount / 2);
}

TEST(AttributeStream, RefusesWhatIsNotWhatWasAskedFor) {
  const auto values = numbers(300, [](std::size_t i) { return static_cast<std::uint32_t>(i); });
  ByteWriter out;
  AttributeWriter(out).integers(values, 3, 10, Values::kAbsolute);
  const auto refused = [&](std::size_t rows, std::size_t columns, unsigned bits) {
    ByteReader in(out.bytes());
    return !AttributeReader(in).integers(rows, columns, bits).has_value();
  };
  EXPECT_TRUE(refused(101, 3, 10));
  EXPECT_TRUE(refused(99, 3, 10));
  EXPECT_TRUE(refused(100, 4, 10));
  for (std::size_t n = 0; n < out.size(); ++n) {
    ByteReader in(out.bytes().first(n));
    EXPECT_FALSE(AttributeReader(in).integers(100, 3, 10).has_value()) << n;
  }
  ByteWriter wide;
  AttributeWriter(wide).integers(numbers(10, [](std::size_t) { return 1023U; }), 1, 10, Values::kAbsolute);
  ByteReader in(wide.bytes());
  EXPECT_FALSE(AttributeReader(in).integers(10, 1, 9).has_value());  // out of the range of nine bits
}

TEST(AttributeStream, BoundsBytesOfUnknownNumber) {
  ByteWriter out;
  AttributeWriter(out).sized_bytes(std::vector<std::byte>(1000));
  ByteReader in(out.bytes());
  EXPECT_EQ(AttributeReader(in).sized_bytes(1000)->size(), 1000U);
  ByteReader again(out.bytes());
  EXPECT_FALSE(AttributeReader(again).sized_bytes(999).has_value());
}

TEST(Varint, RoundTripsAndEnds) {
  for (const std::uint64_t value : {std::uint64_t{0}, std::uint64_t{127}, std::uint64_t{128},
                                    std::uint64_t{1} << 63U, std::numeric_limits<std::uint64_t>::max()}) {
    ByteWriter out;
    write_varint(out, value);
    EXPECT_LE(out.size(), 10U);
    ByteReader in(out.bytes());
    EXPECT_EQ(read_varint(in), value);
    EXPECT_TRUE(in.ok());
    EXPECT_EQ(unzigzag(zigzag(value)), value);
  }
  const std::vector<std::byte> endless(20, std::byte{0xFF});
  ByteReader in(endless);
  (void)read_varint(in);
  EXPECT_FALSE(in.ok());
}

}  // namespace
}  // namespace edgesplat::map
