// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/map/keyframe_codec.hpp"

#include "common/base/crc32c.hpp"
#include "test/support/map_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace edgesplat::map {
namespace {

using test::random_keyframe;

/// Puts the right CRC32C on bytes that were changed on purpose.
void reseal(std::vector<std::byte>& bytes) {
  const std::span<const std::byte> all(bytes);
  const std::uint32_t crc = crc32c(all.subspan(16), crc32c(all.first(12)));
  std::memcpy(bytes.data() + 12, &crc, sizeof(crc));
}

TEST(KeyframeCodec, RoundTripsEverything) {
  const Keyframe keyframe = random_keyframe(7, 500, 1);
  const auto bytes = encode_keyframe(keyframe);
  ASSERT_TRUE(bytes.has_value());
  const auto back = decode_keyframe(*bytes);
  ASSERT_TRUE(back.has_value()) << back.error().context;
  EXPECT_EQ(back->id, keyframe.id);
  EXPECT_EQ(back->stamp, keyframe.stamp);
  EXPECT_EQ(back->pose_version, 2U);
  EXPECT_EQ(back->exposure_s, keyframe.exposure_s);
  EXPECT_EQ(back->odom_from_body.rotation.coeffs(), keyframe.odom_from_body.rotation.coeffs());
  EXPECT_EQ(back->odom_from_body.translation_m, keyframe.odom_from_body.translation_m);
  EXPECT_EQ(back->pose_covariance, keyframe.pose_covariance);
  ASSERT_TRUE(back->camera.has_value());
  EXPECT_EQ(back->camera->model.kind, geometry::CameraKind::kFisheye);
  EXPECT_EQ(back->camera->model.fx_px, 320.5);
  EXPECT_EQ(back->camera->model.distortion, keyframe.camera->model.distortion);
  EXPECT_EQ(back->camera->stamp_delay_s, 0.002);
  EXPECT_EQ(back->camera->body_from_camera.translation_m, keyframe.camera->body_from_camera.translation_m);
  ASSERT_NE(back->image, nullptr);
  EXPECT_EQ(back->image->bytes, keyframe.image->bytes);
  EXPECT_EQ(back->image->width_px, 640);
  ASSERT_EQ(back->points_in_body.size(), 500U);
  for (std::size_t i = 0; i < 500; ++i) {
    EXPECT_EQ(back->points_in_body[i].rgb, keyframe.points_in_body[i].rgb);
    EXPECT_EQ(back->points_in_body[i].has_colour, keyframe.points_in_body[i].has_colour);
  }
}

TEST(KeyframeCodec, WithoutCameraImageAndPoints) {
  Keyframe keyframe;
  const auto bytes = encode_keyframe(keyframe);
  ASSERT_TRUE(bytes.has_value());
  const auto back = decode_keyframe(*bytes);
  ASSERT_TRUE(back.has_value()) << back.error().context;
  EXPECT_FALSE(back->camera.has_value());
  EXPECT_EQ(back->image, nullptr);
  EXPECT_TRUE(back->points_in_body.empty());
}

// The promise in the header: 0.5 mm for points within 32 m, 1.1 mm at 140 m, 15.3 mm at the limit (and float
// rounding).
TEST(KeyframeCodec, PointsKeepTheirStatedAccuracy) {
  const std::pair<float, float> cases[] = {{32.0F, 0.51e-3F}, {70.0F, 1.1e-3F}, {1000.0F, 15.4e-3F}};
  for (const auto& [half_width_m, allowed_m] : cases) {
    Keyframe keyframe = random_keyframe(1, 0, 1);
    std::uint64_t state = 5;
    for (int i = 0; i < 3000; ++i) {
      ColouredPoint point;
      for (int k = 0; k < 3; ++k) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        point.p_in_body_m[k] = half_width_m * (static_cast<float>(state >> 40U) / 8388608.0F - 1.0F);
      }
      keyframe.points_in_body.push_back(point);
    }
    const auto back = decode_keyframe(*encode_keyframe(keyframe));
    ASSERT_TRUE(back.has_value());
    float worst_m = 0.0F;
    for (std::size_t i = 0; i < keyframe.points_in_body.size(); ++i) {
      const auto error = back->points_in_body[i].p_in_body_m - keyframe.points_in_body[i].p_in_body_m;
      worst_m = std::max(worst_m, error.cwiseAbs().maxCoeff());
    }
    EXPECT_LE(worst_m, allowed_m);
    EXPECT_GT(worst_m, 0.1F * allowed_m);  // else the test measures nothing
  }
}

TEST(KeyframeCodec, SkipsSectionsOfLaterVersions) {
  auto bytes = *encode_keyframe(random_keyframe(7, 10, 1));
  const std::uint16_t tag = 900;
  const std::uint32_t length = 5;
  const auto* tag_bytes = reinterpret_cast<const std::byte*>(&tag);
  const auto* length_bytes = reinterpret_cast<const std::byte*>(&length);
  bytes.insert(bytes.end(), tag_bytes, tag_bytes + 2);
  bytes.insert(bytes.end(), length_bytes, length_bytes + 4);
  bytes.insert(bytes.end(), 5, std::byte{0xAB});
  std::uint16_t sections = 0;
  std::memcpy(&sections, bytes.data() + 6, 2);
  ++sections;
  std::memcpy(bytes.data() + 6, &sections, 2);
  const auto total = static_cast<std::uint32_t>(bytes.size() - 16);
  std::memcpy(bytes.data() + 8, &total, 4);
  reseal(bytes);
  const auto back = decode_keyframe(bytes);
  ASSERT_TRUE(back.has_value()) << back.error().context;
  EXPECT_EQ(back->points_in_body.size(), 10U);
}

TEST(KeyframeCodec, RefusesEveryTruncation) {
  const auto bytes = *encode_keyframe(random_keyframe(7, 20, 1));
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_FALSE(decode_keyframe(std::span<const std::byte>(bytes).first(n)).has_value()) << n;
  }
}

TEST(KeyframeCodec, RefusesEveryFlippedBit) {
  auto bytes = *encode_keyframe(random_keyframe(7, 5, 1));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] ^= std::byte{0x10};
    const auto back = decode_keyframe(bytes);
    ASSERT_FALSE(back.has_value()) << i;
    EXPECT_EQ(back.error().code, Errc::kCorrupt);
    bytes[i] ^= std::byte{0x10};
  }
}

// A sender with a bug or bad intent can put the right CRC on anything.
TEST(KeyframeCodec, SurvivesFlippedBitsUnderARightCrc) {
  const auto good = *encode_keyframe(random_keyframe(7, 5, 1));
  int accepted = 0;
  for (std::size_t i = 16; i < good.size(); ++i) {
    for (const unsigned value : {0x00U, 0x7FU, 0xFFU}) {
      auto bytes = good;
      bytes[i] = static_cast<std::byte>(value);
      reseal(bytes);
      const auto back = decode_keyframe(bytes);
      if (!back) continue;
      ++accepted;
      EXPECT_TRUE(back->odom_from_body.is_finite());
      for (const auto& point : back->points_in_body) EXPECT_TRUE(point.p_in_body_m.allFinite());
    }
  }
  EXPECT_GT(accepted, 0);
}

TEST(KeyframeCodec, AnAbsurdPointCountAllocatesNothing) {
  auto bytes = *encode_keyframe(random_keyframe(7, 5, 1));
  // The points' section follows the core's and the camera's: find its count by its tag.
  std::size_t at = 16;
  while (true) {
    std::uint16_t tag = 0;
    std::uint32_t length = 0;
    std::memcpy(&tag, bytes.data() + at, 2);
    std::memcpy(&length, bytes.data() + at + 2, 4);
    if (tag == 2) break;
    at += 6 + length;
  }
  for (const std::uint32_t count : {6U, 1U << 20U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
    std::memcpy(bytes.data() + at + 7, &count, 4);
    reseal(bytes);
    EXPECT_FALSE(decode_keyframe(bytes).has_value()) << count;
  }
}

TEST(KeyframeCodec, TheEncoderRefusesWhatIsNoNumber) {
  const auto refused = [](auto change) {
    Keyframe keyframe = random_keyframe(7, 5, 1);
    change(keyframe);
    const auto bytes = encode_keyframe(keyframe);
    return !bytes && bytes.error().code == Errc::kInvalidArgument;
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refused([](Keyframe& k) { k.points_in_body[3].p_in_body_m.y() = kNan; }));
  EXPECT_TRUE(refused([](Keyframe& k) { k.points_in_body[0].p_in_body_m.x() = 1001.0F; }));
  EXPECT_TRUE(refused([](Keyframe& k) { k.odom_from_body.translation_m.x() = kNan; }));
  EXPECT_TRUE(refused([](Keyframe& k) { k.odom_from_body.rotation.coeffs() *= 2.0; }));
  EXPECT_TRUE(refused([](Keyframe& k) { k.pose_covariance(1, 1) = kNan; }));
  EXPECT_TRUE(refused([](Keyframe& k) { k.camera->model.fx_px = -1.0; }));
  EXPECT_TRUE(refused([](Keyframe& k) { k.image = std::make_shared<EncodedImage>(); }));
}

}  // namespace
}  // namespace edgesplat::map
