// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/delta_codec.hpp"

#include "common/base/crc32c.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace edgesplat::map {
namespace {

constexpr std::size_t kCrcAt = kDeltaHeader_bytes - 4;

void reseal(std::vector<std::byte>& bytes) {
  const std::span<const std::byte> all(bytes);
  const std::uint32_t crc = crc32c(all.subspan(kDeltaHeader_bytes), crc32c(all.first(kCrcAt)));
  std::memcpy(bytes.data() + kCrcAt, &crc, sizeof(crc));
}

AddDelta sample(std::size_t count, int sh_degree = 0) {
  AddDelta delta;
  delta.header.robot.value = 12;
  for (std::size_t i = 0; i < 16; ++i) delta.header.map.bytes[i] = static_cast<std::byte>(i);
  delta.header.epoch.value = 3;
  delta.header.seq = 1000;
  delta.header.base_seq = 999;
  delta.gaussians = test::random_gaussians(count, 4, sh_degree);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& m = delta.gaussians.means_m;
    delta.chunks.push_back(chunk_of({m[3 * i], m[3 * i + 1], m[3 * i + 2]}));
  }
  return delta;
}

TEST(DeltaCodec, RoundTripsEveryShDegreeExactly) {
  for (int degree = 0; degree <= 3; ++degree) {
    const AddDelta delta = sample(50, degree);
    const auto bytes = encode_add(delta);
    ASSERT_TRUE(bytes.has_value());
    const auto back = decode_add(*bytes);
    ASSERT_TRUE(back.has_value()) << back.error().context;
    EXPECT_EQ(back->header.robot, delta.header.robot);
    EXPECT_EQ(back->header.map, delta.header.map);
    EXPECT_EQ(back->header.epoch, delta.header.epoch);
    EXPECT_EQ(back->header.seq, 1000U);
    EXPECT_EQ(back->header.base_seq, 999U);
    EXPECT_EQ(back->header.count, 50U);
    EXPECT_EQ(back->chunks, delta.chunks);
    EXPECT_EQ(back->gaussians.sh_degree, degree);
    EXPECT_EQ(back->gaussians.ids, delta.gaussians.ids);
    EXPECT_EQ(back->gaussians.means_m, delta.gaussians.means_m);
    EXPECT_EQ(back->gaussians.log_scales, delta.gaussians.log_scales);
    EXPECT_EQ(back->gaussians.quats_xyzw, delta.gaussians.quats_xyzw);
    EXPECT_EQ(back->gaussians.opacity_logits, delta.gaussians.opacity_logits);
    EXPECT_EQ(back->gaussians.sh, delta.gaussians.sh);
    EXPECT_EQ(back->gaussians.anchors, delta.gaussians.anchors);
  }
}

TEST(DeltaCodec, AnEmptyAddIsOne) {
  const auto back = decode_add(*encode_add(sample(0)));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->gaussians.size(), 0U);
}

// The layout other programs rely on: fields in the stated order, little endian.
TEST(DeltaCodec, TheHeaderLiesAsDocumented) {
  const auto bytes = *encode_add(sample(2));
  const unsigned char expected[] = {'E', 'S', 'D', '1', 1, 0, 12, 0};
  EXPECT_EQ(std::memcmp(bytes.data(), expected, sizeof(expected)), 0);
  EXPECT_EQ(bytes[8 + 15], std::byte{15});  // map uuid
  EXPECT_EQ(bytes[24], std::byte{3});       // epoch
  EXPECT_EQ(bytes[28], std::byte{0xE8});    // seq 1000
  EXPECT_EQ(bytes[36], std::byte{0xE7});    // base seq 999
  EXPECT_EQ(bytes[44], std::byte{1});       // kind
  EXPECT_EQ(bytes[45], std::byte{2});       // count
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 49, 4);
  EXPECT_EQ(length, bytes.size() - 57);
}

TEST(DeltaCodec, RefusesEveryTruncationAndFlippedBit) {
  auto bytes = *encode_add(sample(3));
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_FALSE(decode_add(std::span<const std::byte>(bytes).first(n)).has_value()) << n;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] ^= std::byte{0x04};
    EXPECT_FALSE(decode_add(bytes).has_value()) << i;
    bytes[i] ^= std::byte{0x04};
  }
}

TEST(DeltaCodec, RefusesAbsurdCountsUnderARightCrc) {
  const auto good = *encode_add(sample(3));
  const auto refused = [&](std::size_t at, std::uint32_t value) {
    auto bytes = good;
    std::memcpy(bytes.data() + at, &value, sizeof(value));
    reseal(bytes);
    const auto back = decode_add(bytes);
    return !back && back.error().code == Errc::kCorrupt;
  };
  for (const std::uint32_t value : {4U, 65537U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
    EXPECT_TRUE(refused(45, value)) << "count " << value;
    EXPECT_TRUE(refused(49, value)) << "length " << value;
    EXPECT_TRUE(refused(61, value)) << "chunk runs " << value;
    EXPECT_TRUE(refused(65 + 12, value)) << "rows of the first run " << value;
  }
  EXPECT_TRUE(refused(65 + 12, 0));
}

TEST(DeltaCodec, SurvivesAnyByteUnderARightCrc) {
  const auto good = *encode_add(sample(2));
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (const unsigned value : {0x00U, 0x7FU, 0xFFU}) {
      auto bytes = good;
      bytes[i] = static_cast<std::byte>(value);
      reseal(bytes);
      const auto back = decode_add(bytes);
      if (!back) continue;
      for (const float v : back->gaussians.means_m) EXPECT_LE(std::abs(v), kMapLimit_m);
      for (const float v : back->gaussians.opacity_logits) EXPECT_TRUE(std::isfinite(v));
    }
  }
}

TEST(DeltaCodec, TheEncoderRefusesWhatTheDecoderWould) {
  const auto refused = [](auto change) {
    AddDelta delta = sample(5);
    change(delta);
    return !encode_add(delta).has_value();
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refused([](AddDelta& d) { d.gaussians.means_m[4] = kNan; }));
  EXPECT_TRUE(refused([](AddDelta& d) { d.gaussians.means_m[4] = 2e6F; }));
  EXPECT_TRUE(refused([](AddDelta& d) { d.gaussians.sh[0] = kNan; }));
  EXPECT_TRUE(refused([](AddDelta& d) { d.gaussians.quats_xyzw.assign(20, 0.0F); }));
  EXPECT_TRUE(refused([](AddDelta& d) { d.chunks.pop_back(); }));
  EXPECT_TRUE(refused([](AddDelta& d) { d.gaussians.means_m.pop_back(); }));
}

}  // namespace
}  // namespace edgesplat::map
