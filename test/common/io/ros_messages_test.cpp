// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/ros_messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace edgesplat::io {
namespace {

std::vector<std::byte> some_bytes() {
  return {std::byte{1}, std::byte{2}, std::byte{3}};
}

TEST(RosMessages, RawDatagram) {
  const auto bytes = some_bytes();
  const auto payload = encode(RawDatagram{bytes});
  EXPECT_EQ(payload.size(), 4U + 4U + 3U);
  const auto decoded = decode_raw_datagram(payload);
  ASSERT_TRUE(decoded);
  EXPECT_TRUE(std::ranges::equal(decoded->datagram, bytes));
}

TEST(RosMessages, FrameMeta) {
  const FrameMeta message{sensor_time_from_ns(1'234'567'890'123), 42, 0.01F, 3.5F, sensor::StampSource::kPtp};
  const auto decoded = decode_frame_meta(encode(message));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->stamp, message.stamp);
  EXPECT_EQ(decoded->sequence, 42U);
  EXPECT_EQ(decoded->exposure_s, 0.01F);
  EXPECT_EQ(decoded->gain_db, 3.5F);
  EXPECT_EQ(decoded->stamp_source, sensor::StampSource::kPtp);
}

TEST(RosMessages, FrameMetaWithImpossibleValuesIsRefused) {
  FrameMeta message;
  message.exposure_s = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(decode_frame_meta(encode(message)));
  auto payload = encode(FrameMeta{});
  payload.back() = std::byte{7};  // no such stamp source
  EXPECT_FALSE(decode_frame_meta(payload));
}

TEST(RosMessages, CompressedImage) {
  const auto bytes = some_bytes();
  const auto payload = encode(CompressedImage{sensor_time_from_ns(-1), "camera", "jpeg", bytes});
  const auto decoded = decode_compressed_image(payload);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(to_ns(decoded->stamp), -1);  // sec -1, nanosec 999999999
  EXPECT_EQ(decoded->frame_id, "camera");
  EXPECT_EQ(decoded->format, "jpeg");
  EXPECT_TRUE(std::ranges::equal(decoded->encoded, bytes));
}

TEST(RosMessages, PoseStamped) {
  PoseStamped message{host_time_from_ns(5'000'000'001), "world", {}};
  message.frame_from_body.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  message.frame_from_body.translation_m = {1.0, -2.0, 3.25};
  const auto decoded = decode_pose_stamped(encode(message));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->stamp, message.stamp);
  EXPECT_EQ(decoded->frame_id, "world");
  EXPECT_EQ(decoded->frame_from_body.translation_m, message.frame_from_body.translation_m);
  EXPECT_EQ(decoded->frame_from_body.rotation.coeffs(), message.frame_from_body.rotation.coeffs());
  message.frame_from_body.rotation.coeffs().setZero();
  EXPECT_FALSE(decode_pose_stamped(encode(message)));
}

TEST(RosMessages, EveryTruncationIsRefused) {
  const auto bytes = some_bytes();
  const auto datagram = encode(RawDatagram{bytes});
  const auto meta = encode(FrameMeta{});
  const auto image = encode(CompressedImage{{}, "camera", "png", bytes});
  const auto pose = encode(PoseStamped{{}, "world", {}});
  const auto refuses = [](const std::vector<std::byte>& payload, auto decode) {
    for (std::size_t length = 0; length < payload.size(); ++length) {
      const auto decoded = decode(std::span(payload).first(length));
      ASSERT_FALSE(decoded) << length;
      ASSERT_EQ(decoded.error().code, Errc::kCorrupt);
    }
  };
  refuses(datagram, decode_raw_datagram);
  refuses(meta, decode_frame_meta);
  refuses(image, decode_compressed_image);
  refuses(pose, decode_pose_stamped);
}

TEST(RosMessages, SchemasDefineEveryTypeTheyUse) {
  for (const auto& [schema, type] : {std::pair{kCompressedImageSchema, "MSG: std_msgs/Header\n"},
                                     {kPoseStampedSchema, "MSG: geometry_msgs/Point\n"},
                                     {kPoseStampedSchema, "MSG: builtin_interfaces/Time\n"},
                                     {kFrameMetaSchema, "MSG: builtin_interfaces/Time\n"}}) {
    EXPECT_THAT(std::string(schema.text), ::testing::HasSubstr(std::string(80, '=') + "\n" + type));
  }
}

}  // namespace
}  // namespace edgesplat::io
