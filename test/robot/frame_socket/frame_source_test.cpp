// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/frame_socket/frame_source.hpp"

#include "common/io/image_file.hpp"

#include <gtest/gtest.h>

namespace edgesplat::frame_socket {
namespace {

EncodedFrame frame(std::uint32_t sequence, std::int64_t stamp_ns, int width = 4, int height = 3) {
  EncodedFrame out;
  out.header.sequence = sequence;
  out.header.stamp = sensor_time_from_ns(stamp_ns);
  out.header.exposure_s = 0.01F;
  out.header.width_px = static_cast<std::uint16_t>(width);
  out.header.height_px = static_cast<std::uint16_t>(height);
  out.payload = io::encode_png(sensor::ImageRgb8(width, height, 200)).value();
  return out;
}

TEST(FrameSource, HandsOnDecodedPictures) {
  FrameSource source({4, 3});
  const auto measurement = source.on_frame(frame(7, 123), host_time_from_ns(9));
  ASSERT_TRUE(measurement.has_value());
  const auto& out = std::get<sensor::CameraFrame>(*measurement);
  EXPECT_EQ(to_ns(out.stamp), 123);
  EXPECT_EQ(to_ns(out.arrival), 9);
  EXPECT_EQ(out.sequence, 7U);
  EXPECT_FLOAT_EQ(out.exposure_s, 0.01F);
  ASSERT_NE(out.image, nullptr);
  EXPECT_EQ(out.image->width_px, 4);
  EXPECT_EQ(out.image->values.front(), 200);
}

TEST(FrameSource, CountsHolesDuplicatesAndRestarts) {
  FrameSource source;
  EXPECT_TRUE(source.on_frame(frame(10, 1000), {}));
  EXPECT_TRUE(source.on_frame(frame(13, 1300), {}));
  EXPECT_FALSE(source.on_frame(frame(13, 1300), {}));
  EXPECT_FALSE(source.on_frame(frame(12, 1200), {}));
  EXPECT_TRUE(source.on_frame(frame(0, 2000), {}));  // the camera counts anew, time goes on
  EXPECT_TRUE(source.on_frame(frame(1, 2100), {}));
  EXPECT_EQ(source.counters().lost, 2U);
  EXPECT_EQ(source.counters().duplicate, 2U);
  EXPECT_EQ(source.counters().restarts, 1U);
  EXPECT_EQ(source.counters().frames, 4U);
}

TEST(FrameSource, RefusesPicturesThatAreNot) {
  FrameSource source({4, 3});
  EncodedFrame cut = frame(1, 100);
  cut.payload.resize(cut.payload.size() / 2);
  EXPECT_FALSE(source.on_frame(cut, {}));
  EncodedFrame lies = frame(2, 200, 5, 5);
  lies.header.width_px = 4;
  lies.header.height_px = 3;
  EXPECT_FALSE(source.on_frame(lies, {}));
  EXPECT_FALSE(source.on_frame(frame(3, 300, 5, 5), {}));
  EXPECT_EQ(source.counters().bad_pictures, 2U);
  EXPECT_EQ(source.counters().wrong_size, 1U);
  EXPECT_EQ(source.counters().frames, 0U);
}

}  // namespace
}  // namespace edgesplat::frame_socket
