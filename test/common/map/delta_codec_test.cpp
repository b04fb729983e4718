// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/delta_codec.hpp"

#include "common/base/crc32c.hpp"
#include "test/common/map/delta_samples.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <numeric>

namespace edgesplat::map {
namespace {

using test::all_kinds;
using test::same_rows;

void reseal(std::vector<std::byte>& bytes) {
  constexpr std::size_t kCrcAt = kDeltaHeader_bytes - 4;
  const auto length = static_cast<std::uint32_t>(bytes.size() - kDeltaHeader_bytes);
  std::memcpy(bytes.data() + kCrcAt - 4, &length, sizeof(length));
  const std::span<const std::byte> all(bytes);
  const std::uint32_t crc = crc32c(all.subspan(kDeltaHeader_bytes), crc32c(all.first(kCrcAt)));
  std::memcpy(bytes.data() + kCrcAt, &crc, sizeof(crc));
}

Delta round_trip(const Delta& delta) {
  const auto bytes = encode_delta(delta);
  EXPECT_TRUE(bytes.has_value()) << bytes.error().context;
  auto back = decode_delta(*bytes);
  EXPECT_TRUE(back.has_value()) << back.error().context;
  EXPECT_EQ(back->header.kind, delta.kind());
  EXPECT_EQ(back->header.seq, delta.header.seq);
  EXPECT_EQ(back->header.base_seq, delta.header.base_seq);
  EXPECT_EQ(back->header.map, delta.header.map);
  EXPECT_EQ(back->header.robot, delta.header.robot);
  EXPECT_EQ(back->header.epoch, delta.header.epoch);
  return *back;
}

TEST(DeltaCodec, WholeGaussiansRoundTripExactlyAtEveryShDegree) {
  for (int degree = 0; degree <= 3; ++degree) {
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{500}}) {
      const Delta delta{test::sample_header(), AddBody{test::random_rows(count, 4, degree)}};
      const Delta back = round_trip(delta);
      EXPECT_TRUE(same_rows(std::get<AddBody>(back.body).rows, std::get<AddBody>(delta.body).rows));
    }
  }
}

TEST(DeltaCodec, UpdatesCarryTheNamedFieldsOnly) {
  const auto before = test::random_rows(200, 4, 1);
  auto after = before;
  for (auto& channels : after.channels) {
    channels[0] = static_cast<std::uint16_t>(channels[0] - 3);
    channels[10] = static_cast<std::uint16_t>((channels[10] + 5) & 255);
  }
  UpdateBody body;
  body.fields = static_cast<FieldMask>(Field::kPosition);
  body.differences.sh_degree = 1;
  for (std::size_t row = 0; row < 200; ++row) append_difference(after, row, before, row, body.differences);
  const auto back = std::get<UpdateBody>(round_trip({test::sample_header(), body}).body);
  auto applied = before;
  for (std::size_t row = 0; row < 200; ++row)
    apply_difference(back.differences, row, back.fields, applied, row);
  for (std::size_t row = 0; row < 200; ++row) {
    EXPECT_EQ(applied.channels[row][0], after.channels[row][0]);
    EXPECT_EQ(applied.channels[row][10], before.channels[row][10]);  // opacity was not named
  }
}

TEST(DeltaCodec, TheOtherKindsRoundTrip) {
  const auto deltas = all_kinds(30);
  const auto removed = std::get<RemoveBody>(round_trip(deltas[2]).body);
  EXPECT_EQ(removed.ids, std::get<RemoveBody>(deltas[2].body).ids);
  const auto replaced = std::get<ChunkReplaceBody>(round_trip(deltas[3]).body);
  const auto& chunk = std::get<ChunkReplaceBody>(deltas[3].body);
  EXPECT_EQ(replaced.chunk, chunk.chunk);
  EXPECT_EQ(replaced.level, chunk.level);
  EXPECT_EQ(replaced.more, chunk.more);
  EXPECT_FALSE(replaced.dropped);
  EXPECT_TRUE(same_rows(replaced.rows, chunk.rows));
  const auto reposed = std::get<ReposeBody>(round_trip(deltas[4]).body).corrections;
  const auto& corrections = std::get<ReposeBody>(deltas[4].body).corrections;
  ASSERT_EQ(reposed.size(), corrections.size());
  for (std::size_t i = 0; i < reposed.size(); ++i) {
    EXPECT_EQ(reposed[i].keyframe, corrections[i].keyframe);
    EXPECT_EQ(reposed[i].version, corrections[i].version);
    const auto& moved = corrections[i].new_map_from_body;
    EXPECT_LT((reposed[i].new_map_from_body.translation_m - moved.translation_m).norm(), 1e-5);
    EXPECT_LT(reposed[i].new_map_from_body.rotation.angularDistance(moved.rotation), 1e-6);
  }
  const auto mask = std::get<MaskBody>(round_trip(deltas[5]).body);
  EXPECT_EQ(mask.dynamic, std::get<MaskBody>(deltas[5].body).dynamic);
  EXPECT_EQ(mask.width_px, 40);
  EXPECT_EQ(mask.version, 3U);
  const auto mapped = std::get<MappedBody>(round_trip(deltas[6]).body);
  EXPECT_EQ(mapped.keyframes, std::get<MappedBody>(deltas[6].body).keyframes);
}

// The layout other programs rely on: fields in the stated order, little endian.
TEST(DeltaCodec, TheHeaderLiesAsDocumented) {
  const auto bytes = *encode_delta({test::sample_header(), AddBody{test::random_rows(2, 4)}});
  const unsigned char expected[] = {'E', 'S', 'D', '1', 3, 0, 12, 0};
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
  for (const Delta& delta : all_kinds(40)) {
    auto bytes = *encode_delta(delta);
    for (std::size_t n = 0; n < bytes.size(); ++n)
      EXPECT_FALSE(decode_delta(std::span<const std::byte>(bytes).first(n)).has_value()) << n;
    for (std::size_t i = 0; i < 8 * bytes.size(); i += 3) {
      bytes[i / 8] ^= std::byte{1} << (i % 8);
      EXPECT_FALSE(decode_delta(bytes).has_value()) << i;
      bytes[i / 8] ^= std::byte{1} << (i % 8);
    }
  }
}

TEST(DeltaCodec, RefusesTruncationsAndCountsUnderARightCrc) {
  for (const Delta& delta : all_kinds(40)) {
    const auto good = *encode_delta(delta);
    for (std::size_t n = kDeltaHeader_bytes; n < good.size(); ++n) {
      auto bytes = good;
      bytes.resize(n);
      reseal(bytes);
      EXPECT_FALSE(decode_delta(bytes).has_value()) << to_string(delta.kind()) << " " << n;
    }
    for (const std::uint32_t count : {41U, 65536U, 65537U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
      auto bytes = good;
      std::memcpy(bytes.data() + 45, &count, sizeof(count));
      reseal(bytes);
      EXPECT_FALSE(decode_delta(bytes).has_value()) << to_string(delta.kind()) << " " << count;
    }
    auto longer = good;
    longer.push_back(std::byte{0});
    reseal(longer);
    EXPECT_FALSE(decode_delta(longer).has_value());
  }
}

TEST(DeltaCodec, WhatDecodesUnderARightCrcCanBeEncodedAgain) {
  for (const Delta& delta : all_kinds(20)) {
    const auto good = *encode_delta(delta);
    for (std::size_t i = kDeltaHeader_bytes; i < good.size(); ++i) {
      for (const unsigned value : {0x00U, 0x7FU, 0xFFU}) {
        auto bytes = good;
        bytes[i] = static_cast<std::byte>(value);
        reseal(bytes);
        const auto back = decode_delta(bytes);
        if (!back || back->kind() == DeltaKind::kRepose) continue;  // its quaternions may be 1 % too long
        EXPECT_TRUE(encode_delta(*back).has_value());
      }
    }
  }
}

TEST(DeltaCodec, TheEncoderRefusesWhatTheDecoderWould) {
  const auto refused = [](std::size_t kind, auto change) {
    auto deltas = all_kinds(5);
    change(deltas[kind]);
    return !encode_delta(deltas[kind]).has_value();
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refused(0, [](Delta& d) { std::get<AddBody>(d.body).rows.chunks.pop_back(); }));
  EXPECT_TRUE(refused(1, [](Delta& d) { std::get<UpdateBody>(d.body).fields = 255; }));
  EXPECT_TRUE(refused(2, [](Delta& d) { std::get<RemoveBody>(d.body).ids.resize(kMaxDeltaRecords + 1); }));
  EXPECT_TRUE(refused(3, [](Delta& d) { std::get<ChunkReplaceBody>(d.body).chunk.x += 1; }));
  EXPECT_TRUE(refused(3, [](Delta& d) { std::get<ChunkReplaceBody>(d.body).dropped = true; }));
  EXPECT_TRUE(refused(4, [](Delta& d) {
    std::get<ReposeBody>(d.body).corrections[0].new_map_from_body.translation_m.x() = kNan;
  }));
  EXPECT_TRUE(refused(4, [](Delta& d) {
    std::get<ReposeBody>(d.body).corrections[0].old_map_from_body.rotation.coeffs().setZero();
  }));
  EXPECT_TRUE(refused(5, [](Delta& d) { std::get<MaskBody>(d.body).width_px = 41; }));
  EXPECT_TRUE(refused(6, [](Delta& d) { std::get<MappedBody>(d.body).keyframes = {4, 4}; }));
  EXPECT_TRUE(refused(6, [](Delta& d) { std::get<MappedBody>(d.body).keyframes = {4, 3}; }));
  EXPECT_TRUE(refused(6, [](Delta& d) {
    auto& keyframes = std::get<MappedBody>(d.body).keyframes;
    keyframes.resize(kMaxMappedKeyframes + 1);
    std::iota(keyframes.begin(), keyframes.end(), 0U);
  }));
}

}  // namespace
}  // namespace edgesplat::map
