// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/bytes.hpp"
#include "common/io/atomic_file.hpp"
#include "common/io/byte_compression.hpp"
#include "common/io/spz_gaussians.hpp"
#include "test/common/io/gaussian_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gmock/gmock.h>

namespace edgesplat::io {
namespace {

using ::testing::HasSubstr;

std::vector<std::byte> make_file(std::uint32_t version) {
  const test::TempDir folder;
  EXPECT_TRUE(write_gaussians_spz(folder / "a.spz", make_cloud(20, 1), version));
  return read_file(folder / "a.spz", 1U << 20U).value();
}

std::string refusal(std::span<const std::byte> bytes) {
  const auto cloud = parse_gaussians_spz(bytes);
  return cloud ? "accepted" : cloud.error().context;
}

std::string refusal(std::vector<std::byte> bytes, std::size_t at, std::uint32_t value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
  return refusal(bytes);
}

class SpzHostile : public ::testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Versions, SpzHostile, ::testing::Values(2U, 3U, 4U));

TEST_P(SpzHostile, EveryTruncationIsRefused) {
  const auto whole = make_file(GetParam());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    ASSERT_NE(refusal(std::span(whole).first(length)), "accepted") << length;
  }
}

TEST_P(SpzHostile, EveryDamagedByteIsSurvived) {
  const auto whole = make_file(GetParam());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const auto flip : {std::byte{0x01}, std::byte{0x10}, std::byte{0x80}, std::byte{0xFF}}) {
      auto damaged = whole;
      damaged[i] ^= flip;
      const auto cloud = parse_gaussians_spz(damaged);
      ASSERT_TRUE(!cloud || cloud->consistent());
    }
  }
}

TEST(SpzHostileHeader, AbsurdFieldsAreRefused) {
  const auto whole = make_file(4);
  EXPECT_THAT(refusal({}), HasSubstr("neither"));
  EXPECT_THAT(refusal(whole, 4, 5), HasSubstr("unknown version 5"));
  EXPECT_THAT(refusal(whole, 8, 0xFFFFFFFFU), HasSubstr("4294967295 Gaussians are implausible"));
  EXPECT_THAT(refusal(whole, 8, 19), HasSubstr("another length"));
  EXPECT_THAT(refusal(whole, 12, 0x06000C05U), HasSubstr("SH degree 5"));
  EXPECT_THAT(refusal(whole, 12, 0x06001901U), HasSubstr("fractional bits"));
  EXPECT_THAT(refusal(whole, 12, 0x05000C01U), ::testing::Not("accepted"));
  EXPECT_THAT(refusal(whole, 12, 0xFF000C01U), ::testing::Not("accepted"));
  EXPECT_THAT(refusal(whole, 16, 31), HasSubstr("truncated"));
  EXPECT_THAT(refusal(whole, 16, 0xFFFFFFF0U), HasSubstr("truncated"));
}

TEST(SpzHostileHeader, ABombIsRefusedBeforeItGoesOff) {
  // 64 MiB of zeros take 65 kB as gzip: more than the plausible ratio.
  const auto bomb = gzip(std::vector<std::byte>(std::size_t{64} << 20U)).value();
  ASSERT_LT(bomb.size(), 200'000U);
  EXPECT_THAT(refusal(bomb), HasSubstr("implausibly"));
}

TEST(SpzHostileHeader, AHugeCountInAGzipStreamIsRefused) {
  ByteWriter writer;
  writer.write_text("NGSP");
  writer.write(std::uint32_t{3});
  writer.write(std::uint32_t{0xFFFFFFFF});
  writer.write(std::uint32_t{12U << 8U});
  EXPECT_THAT(refusal(gzip(writer.bytes()).value()), HasSubstr("implausible"));
}

}  // namespace
}  // namespace edgesplat::io
