// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/map_request.hpp"

#include "common/base/crc32c.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace edgesplat::map {
namespace {

MapRequest sample(RequestKind kind = RequestKind::kFetch) {
  return {kind,
          RobotId{7},
          Epoch{4},
          1234567890123ULL,
          1234567890200ULL,
          {1.5F, -2.5F, 3.0F},
          {{1, -2, 3}, {-100000, 0, 100000}}};
}

void reseal(std::vector<std::byte>& bytes) {
  const std::uint32_t crc = crc32c(std::span<const std::byte>(bytes).first(bytes.size() - 4));
  std::memcpy(bytes.data() + bytes.size() - 4, &crc, 4);
}

TEST(MapRequest, RoundTrips) {
  for (int kind = 1; kind <= 5; ++kind) {
    const MapRequest request = sample(static_cast<RequestKind>(kind));
    const auto back = decode_map_request(encode_map_request(request));
    ASSERT_TRUE(back.has_value()) << back.error().context;
    EXPECT_EQ(back->kind, request.kind);
    EXPECT_EQ(back->robot, request.robot);
    EXPECT_EQ(back->epoch, request.epoch);
    EXPECT_EQ(back->seq, request.seq);
    EXPECT_EQ(back->until_seq, request.until_seq);
    EXPECT_EQ(back->robot_in_map_m, request.robot_in_map_m);
    EXPECT_EQ(back->chunks, request.chunks);
  }
}

TEST(MapRequest, LeavesOutWhatIsTooMuch) {
  MapRequest request = sample();
  request.chunks.resize(5000);
  const auto back = decode_map_request(encode_map_request(request));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->chunks.size(), kMaxRequestChunks);
}

TEST(MapRequest, RefusesEveryTruncationAndFlippedBit) {
  auto bytes = encode_map_request(sample());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_FALSE(decode_map_request(std::span<const std::byte>(bytes).first(n)).has_value()) << n;
  for (std::size_t i = 0; i < 8 * bytes.size(); ++i) {
    bytes[i / 8] ^= std::byte{1} << (i % 8);
    EXPECT_FALSE(decode_map_request(bytes).has_value()) << i;
    bytes[i / 8] ^= std::byte{1} << (i % 8);
  }
}

TEST(MapRequest, RefusesNonsenseUnderARightCrc) {
  const auto refused = [](std::size_t at, auto value) {
    auto bytes = encode_map_request(sample());
    std::memcpy(bytes.data() + at, &value, sizeof(value));
    reseal(bytes);
    return !decode_map_request(bytes).has_value();
  };
  EXPECT_TRUE(refused(4, std::uint16_t{9}));  // version
  EXPECT_TRUE(refused(6, std::uint8_t{0}));   // kind
  EXPECT_TRUE(refused(6, std::uint8_t{6}));
  EXPECT_TRUE(refused(29, std::numeric_limits<float>::quiet_NaN()));  // position
  for (const int count : {0, 1, 3, 1025, 65535}) EXPECT_TRUE(refused(41, static_cast<std::uint16_t>(count)));
  EXPECT_TRUE(refused(43, std::int32_t{2000000}));  // chunk
  EXPECT_FALSE(refused(43, std::int32_t{2000}));
}

}  // namespace
}  // namespace edgesplat::map
