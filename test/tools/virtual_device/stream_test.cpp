// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/stream.hpp"

#include "common/io/image_file.hpp"
#include "common/io/mcap_writer.hpp"
#include "common/io/recording_topics.hpp"
#include "common/io/ros_messages.hpp"
#include "test/tools/virtual_device/loopback.hpp"
#include "tools/virtual_device/frame_message.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <future>

namespace edgesplat::virtual_device {
namespace {

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

std::vector<std::byte> datagram(std::size_t size, std::uint8_t fill) {
  return std::vector<std::byte>(size, std::byte{fill});
}

class StreamTest : public testing::Test {
 protected:
  StreamTest() {
    path_ = std::filesystem::temp_directory_path() /
            ("stream_test_" + std::to_string(::getpid()) + "_" +
             testing::UnitTest::GetInstance()->current_test_info()->name() + ".mcap");
  }
  ~StreamTest() override { std::filesystem::remove(path_); }

  // Ten point datagrams, ten IMU datagrams and two pictures over 100 ms.
  void write_recording() {
    auto writer = io::McapWriter::create(path_);
    ASSERT_TRUE(writer.has_value()) << writer.error().context;
    const auto channel = [&](std::string_view topic, const io::RosSchema& schema) {
      return *writer->add_channel(topic,
                                  *writer->add_schema(schema.name, io::kRosSchemaEncoding, schema.text));
    };
    const auto points = channel(io::kLidarPointsTopic, io::kRawDatagramSchema);
    const auto imu = channel(io::kLidarImuTopic, io::kRawDatagramSchema);
    const auto meta = channel(io::kCameraMetaTopic, io::kFrameMetaSchema);
    const auto image = channel(io::kCameraImageTopic, io::kCompressedImageSchema);
    jpeg_ = *io::encode_jpeg(sensor::ImageRgb8(16, 8, 100));
    for (std::uint32_t k = 0; k < 10; ++k) {
      const HostTime at = host_time_from_ns(kStart_ns + k * 10'000'000);
      const SensorTime stamp = sensor_time_from_ns(kStart_ns + k * 10'000'000 - 1000);
      const auto point = datagram(1380, static_cast<std::uint8_t>(k));
      const auto inertia = datagram(60, static_cast<std::uint8_t>(k));
      ASSERT_TRUE(writer->write(points, k, at, stamp, io::encode(io::RawDatagram{point})));
      ASSERT_TRUE(writer->write(imu, k, at, stamp, io::encode(io::RawDatagram{inertia})));
      if (k % 5 != 0) continue;
      const io::FrameMeta frame{stamp, 40 + k, 0.004F, 3.0F, sensor::StampSource::kPtp};
      ASSERT_TRUE(writer->write(meta, k, at, stamp, io::encode(frame)));
      ASSERT_TRUE(writer->write(image, k, at, stamp,
                                io::encode(io::CompressedImage{stamp, "camera", "jpeg", jpeg_})));
    }
    ASSERT_TRUE(writer->close());
  }
  StreamOptions options() const {
    StreamOptions out;
    out.recording = path_;
    out.points_port = points_.port();
    out.imu_port = imu_.port();
    out.frame_port = 0;
    out.wait_for_camera_s = 0.0;
    return out;
  }
  std::filesystem::path path_;
  std::vector<std::byte> jpeg_;
  UdpListener points_, imu_;
};

TEST_F(StreamTest, DatagramsArriveAsRecordedAtTheirPace) {
  write_recording();
  const auto start = std::chrono::steady_clock::now();
  const auto report = stream_recording(options(), {});
  const auto took = std::chrono::steady_clock::now() - start;
  ASSERT_TRUE(report.has_value()) << report.error().context;
  EXPECT_GE(took, std::chrono::milliseconds(90));
  EXPECT_LT(took, std::chrono::milliseconds(2000));
  EXPECT_EQ(report->points_sent, 10U);
  EXPECT_EQ(report->imu_sent, 10U);
  EXPECT_EQ(report->frames_lost, 2U);
  EXPECT_FALSE(report->camera_connected);
  for (std::uint8_t k = 0; k < 10; ++k) {
    EXPECT_EQ(points_.receive(), datagram(1380, k));
    EXPECT_EQ(imu_.receive(), datagram(60, k));
  }
}

TEST_F(StreamTest, FramesCarryTheirMetaAndExactPicture) {
  write_recording();
  // A free port for this moment; the server tells its own only to itself.
  std::uint16_t port = 0;
  {
    const UdpListener probe;
    port = probe.port();
  }
  StreamOptions with_camera = options();
  with_camera.frame_port = port;
  with_camera.wait_for_camera_s = 5.0;
  auto streaming = std::async(std::launch::async, [&] { return stream_recording(with_camera, {}); });
  const UniqueFd robot = connect_to(port);
  const auto received = read_bytes(robot.get(), 1 << 20);
  const auto report = streaming.get();
  ASSERT_TRUE(report.has_value()) << report.error().context;
  EXPECT_TRUE(report->camera_connected);
  EXPECT_EQ(report->frames_sent, 2U);

  FrameMessage first;
  first.sequence = 40;
  first.stamp = sensor_time_from_ns(kStart_ns - 1000);
  first.exposure_s = 0.004F;
  first.gain_db = 3.0F;
  first.stamp_source = sensor::StampSource::kPtp;
  first.width_px = 16;
  first.height_px = 8;
  ASSERT_EQ(received.size(), 2 * (kFrameHeaderBytes + jpeg_.size()));
  const auto header = encode_frame_header(first, jpeg_);
  EXPECT_TRUE(std::equal(header.begin(), header.end(), received.begin()));
  EXPECT_TRUE(std::equal(jpeg_.begin(), jpeg_.end(), received.begin() + kFrameHeaderBytes));
}

TEST_F(StreamTest, FaultsAreCounted) {
  write_recording();
  StreamOptions bad_wire = options();
  bad_wire.speed = 100.0;
  bad_wire.faults = {.flip = 1.0, .drop = 0.3};
  const auto report = stream_recording(bad_wire, {});
  ASSERT_TRUE(report.has_value());
  EXPECT_GT(report->dropped, 0U);
  EXPECT_EQ(report->dropped + report->flipped, 20U);
  EXPECT_EQ(report->points_sent + report->imu_sent + report->dropped, 20U);
}

TEST_F(StreamTest, StopEndsItEarly) {
  write_recording();
  std::stop_source stop;
  stop.request_stop();
  const auto report = stream_recording(options(), stop.get_token());
  ASSERT_TRUE(report.has_value());
  EXPECT_TRUE(report->stopped);
  EXPECT_EQ(report->points_sent, 0U);
}

TEST_F(StreamTest, RefusesWhatMakesNoSense) {
  EXPECT_EQ(stream_recording(options(), {}).error().code, Errc::kNotFound);
  write_recording();
  StreamOptions wrong = options();
  wrong.speed = 0.0;
  EXPECT_EQ(stream_recording(wrong, {}).error().code, Errc::kInvalidConfig);
  wrong = options();
  wrong.to = "robot.local";
  EXPECT_EQ(stream_recording(wrong, {}).error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace edgesplat::virtual_device
