// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/ros_recording.hpp"

#include "common/io/image_file.hpp"
#include "common/io/mcap_writer.hpp"
#include "common/sensor/rig_config.hpp"
#include "robot/drivers/livox/point_record.hpp"
#include "test/common/io/ros_samples.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace edgesplat::replay {
namespace {

using io::BagCompression;
using io::RosEncoding;
using io::SampleMessage;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kMs = 1'000'000;

BagRig small_rig(bool camera = true) {
  BagRig rig;
  rig.rig.imu.emplace();
  if (camera) {
    rig.rig.camera.emplace();
    rig.rig.camera->model = {geometry::CameraKind::kPinhole, 16, 12, 16.0, 16.0, 7.5, 5.5, {}};
  }
  return rig;
}

/// 0.5 s: sweeps of 100 ms, IMU each 5 ms in g, pictures each 100 ms; recorded 3 ms after their ends.
std::vector<SampleMessage> recording(RosEncoding encoding, const std::string& driver) {
  std::vector<SampleMessage> messages;
  const auto png = io::encode_png(sensor::ImageRgb8(16, 12, 40)).value();
  for (int ms = 0; ms < 500; ms += 5) {
    const std::int64_t t = kStart_ns + ms * kMs;
    messages.push_back({"/livox/imu", "sensor_msgs/Imu", t + 3 * kMs,
                        io::imu_message(encoding, t, {0.1, 0.2, 0.3}, {0.0, 0.0, 1.0})});
    if (ms % 100 != 0) continue;
    messages.push_back({"/cam/compressed", "sensor_msgs/CompressedImage", t + 3 * kMs,
                        io::compressed_image_message(encoding, t, "png", png)});
    if (ms == 0) continue;
    std::vector<io::SamplePoint> points;
    for (std::uint32_t i = 0; i < 100; ++i)
      points.push_back({i * 1'000'000, 1.0F + 0.1F * static_cast<float>(i), 2.0F, 3.0F, 51, 0, 1});
    messages.push_back({"/livox/lidar", driver + "/CustomMsg", t + 3 * kMs,
                        io::livox_message(encoding, t - 100 * kMs, points)});
  }
  return messages;
}

struct Content {
  std::vector<sensor::ImuSample> imu;
  std::vector<sensor::LidarPacket> packets;
  std::vector<sensor::CameraFrame> frames;
};
Content read_all(ReplaySource& source) {
  Content content;
  HostTime latest{};
  while (true) {
    auto next = source.next();
    EXPECT_TRUE(next);
    if (!next || !*next) return content;
    EXPECT_GE(sensor::arrival_of(**next), latest);
    latest = sensor::arrival_of(**next);
    if (auto* imu = std::get_if<sensor::ImuSample>(&**next)) content.imu.push_back(*imu);
    if (auto* packet = std::get_if<sensor::LidarPacket>(&**next)) content.packets.push_back(*packet);
    if (auto* frame = std::get_if<sensor::CameraFrame>(&**next)) content.frames.push_back(*frame);
  }
}

void expect_recording(const std::filesystem::path& path) {
  auto source = ReplaySource::open(path, small_rig());
  ASSERT_TRUE(source) << source.error().context;
  EXPECT_TRUE(source->rig().camera && source->rig().imu);
  EXPECT_EQ(to_ns(source->begin()), kStart_ns + 3 * kMs);
  EXPECT_EQ(source->duration(), nanoseconds(495 * kMs));
  const Content content = read_all(*source);
  EXPECT_TRUE(source->report().complete) << source->report().why;
  ASSERT_EQ(content.imu.size(), 100U);
  EXPECT_EQ(to_ns(content.imu[3].stamp), kStart_ns + 15 * kMs);
  EXPECT_EQ(content.imu[3].stamp_source, sensor::StampSource::kPtp);
  EXPECT_EQ(content.imu[3].gyro_radps, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_DOUBLE_EQ(content.imu[3].accel_mps2.z(), livox::kStandardGravity_mps2) << "Livox writes g";
  ASSERT_EQ(content.packets.size(), 4U);
  EXPECT_EQ(to_ns(content.packets[1].stamp), kStart_ns + 100 * kMs);
  EXPECT_EQ(content.packets[1].span, nanoseconds(99 * kMs));
  ASSERT_EQ(content.packets[1].points.size(), 100U);
  EXPECT_EQ(content.packets[1].points[7].offset_ns, 7'000'000);
  EXPECT_FLOAT_EQ(content.packets[1].points[7].reflectivity, 0.2F);
  ASSERT_EQ(content.frames.size(), 5U);
  EXPECT_EQ(to_ns(content.frames[2].stamp), kStart_ns + 200 * kMs);
  EXPECT_EQ(content.frames[2].image->width_px, 16);
  EXPECT_EQ(int{content.frames[2].image->values[5]}, 40);
}

TEST(RosRecording, Ros1Bags) {
  const test::TempDir folder;
  for (const auto compression : {BagCompression::kNone, BagCompression::kBz2, BagCompression::kLz4})
    expect_recording(folder.write(
        "a.bag", io::rosbag1_bytes(recording(RosEncoding::kRos1, "livox_ros_driver"), compression)));
}

TEST(RosRecording, Ros2SqliteFileAndFolder) {
  const test::TempDir folder;
  std::filesystem::create_directories(folder / "bag");
  io::write_rosbag2_sqlite(folder / "bag/bag_0.db3", recording(RosEncoding::kCdr, "livox_ros_driver2"));
  expect_recording(folder / "bag/bag_0.db3");
  expect_recording(folder / "bag");
}

TEST(RosRecording, Ros2Mcap) {
  const test::TempDir folder;
  auto writer = io::McapWriter::create(folder / "a.mcap");
  ASSERT_TRUE(writer);
  std::map<std::string, io::McapChannelId> channels;
  for (const SampleMessage& message : recording(RosEncoding::kCdr, "livox_ros_driver2")) {
    if (!channels.contains(message.topic)) {
      const auto slash = message.type.find('/');
      const std::string type = message.type.substr(0, slash) + "/msg" + message.type.substr(slash);
      const auto schema = writer->add_schema(type, "ros2msg", "").value();
      channels[message.topic] = writer->add_channel(message.topic, schema).value();
    }
    ASSERT_TRUE(writer->write(channels[message.topic], 0, host_time_from_ns(message.time_ns),
                              sensor_time_from_ns(message.time_ns), message.payload));
  }
  ASSERT_TRUE(writer->close());
  expect_recording(folder / "a.mcap");
}

TEST(RosRecording, WithoutARigItSaysWhereToFindOne) {
  const test::TempDir folder;
  const auto path = folder.write(
      "a.bag", io::rosbag1_bytes(recording(RosEncoding::kRos1, "livox_ros_driver"), BagCompression::kNone));
  const auto source = ReplaySource::open(path);
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Errc::kInvalidConfig);
  for (const char* word : {"--rig", "/livox/lidar", "livox_ros_driver/CustomMsg"})
    EXPECT_NE(source.error().context.find(word), std::string::npos) << source.error().context;
}

/// Opens a bag of these messages with this rig.
Result<ReplaySource> open_with(const test::TempDir& folder, const std::vector<SampleMessage>& messages,
                               const BagRig& rig) {
  return ReplaySource::open(folder.write("t.bag", io::rosbag1_bytes(messages, BagCompression::kNone)), rig);
}

TEST(RosRecording, TopicsAreNamedWhereSeveralFit) {
  const test::TempDir folder;
  auto messages = recording(RosEncoding::kRos1, "livox_ros_driver");
  auto second = messages[0];
  second.topic = "/other/imu";
  messages.push_back(second);
  BagRig rig = small_rig();
  const auto several = open_with(folder, messages, rig);
  ASSERT_FALSE(several);
  EXPECT_EQ(several.error().code, Errc::kInvalidConfig);
  for (const char* word : {"/livox/imu", "/other/imu", "imu_topic"})
    EXPECT_NE(several.error().context.find(word), std::string::npos) << several.error().context;
  rig.replay.imu_topic = "/livox/imu";
  auto named = open_with(folder, messages, rig);
  ASSERT_TRUE(named) << named.error().context;
  EXPECT_EQ(read_all(*named).imu.size(), 100U);
  rig.replay.imu_topic = "/nothing";
  EXPECT_EQ(open_with(folder, messages, rig).error().code, Errc::kInvalidConfig);
  rig.replay.imu_topic = "/livox/lidar";  // of another type
  EXPECT_EQ(open_with(folder, messages, rig).error().code, Errc::kInvalidConfig);
}

TEST(RosRecording, ARecordingWithoutPicturesHasNoCameraOneWithoutImuIsRefused) {
  const test::TempDir folder;
  auto messages = recording(RosEncoding::kRos1, "livox_ros_driver");
  std::erase_if(messages, [](const SampleMessage& message) { return message.topic == "/cam/compressed"; });
  const auto blind = open_with(folder, messages, small_rig());
  ASSERT_TRUE(blind) << blind.error().context;
  EXPECT_FALSE(blind->rig().camera);
  std::erase_if(messages, [](const SampleMessage& message) { return message.topic == "/livox/imu"; });
  const auto no_imu = open_with(folder, messages, small_rig());
  ASSERT_FALSE(no_imu);
  EXPECT_NE(no_imu.error().context.find("[imu]"), std::string::npos);
  BagRig lidar_only = small_rig(false);
  lidar_only.rig.imu.reset();
  auto alone = open_with(folder, messages, lidar_only);
  ASSERT_TRUE(alone) << alone.error().context;
  EXPECT_EQ(read_all(*alone).packets.size(), 4U);
}

TEST(RosRecording, BadMessagesAreCountedAndTheRestIsPlayed) {
  const test::TempDir folder;
  auto messages = recording(RosEncoding::kRos1, "livox_ros_driver");
  for (SampleMessage& message : messages)
    if (message.topic == "/livox/imu" && message.time_ns < kStart_ns + 30 * kMs) message.payload.resize(40);
  BagRig rig = small_rig();
  rig.rig.camera->model.width_px = 17;
  auto source = open_with(folder, messages, rig);
  ASSERT_TRUE(source) << source.error().context;
  const Content content = read_all(*source);
  EXPECT_EQ(content.imu.size(), 94U);
  EXPECT_TRUE(content.frames.empty());
  EXPECT_EQ(source->report().packets_refused, 6U);
  EXPECT_EQ(source->report().frames_refused, 5U);
  EXPECT_NE(source->report().why.find("16x12"), std::string::npos) << source->report().why;
}

TEST(RosRecording, UnitsAndOffsetsAsTold) {
  const test::TempDir folder;
  BagRig rig = small_rig();
  rig.replay.imu_accel_unit = AccelUnit::kMps2;
  rig.replay.imu_stamp_offset_s = 0.5;
  rig.replay.clock = StampClock::kArrival;
  auto source = open_with(folder, recording(RosEncoding::kRos1, "livox_ros_driver"), rig);
  ASSERT_TRUE(source) << source.error().context;
  const Content content = read_all(*source);
  EXPECT_DOUBLE_EQ(content.imu[0].accel_mps2.z(), 1.0);
  EXPECT_EQ(to_ns(content.imu[0].stamp), kStart_ns + 500 * kMs);
  EXPECT_EQ(content.imu[0].stamp_source, sensor::StampSource::kFreeRunning);
}

TEST(BagRig, EveryRigOfThisTreeIsReadAndNamesEveryParameter) {
  int rigs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(EDGESPLAT_SOURCE_DIR "/robot/config/rigs")) {
    ++rigs;
    const auto rig = load_bag_rig(entry.path());
    ASSERT_TRUE(rig) << rig.error().context;
    EXPECT_EQ(entry.path().stem().string(), rig->rig.name);
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (const char* key :
         {"range_sigma_m", "bearing_sigma_rad", "min_range_m", "max_range_m", "translation_m",
          "quaternion_xyzw", "lidar_topic", "imu_topic", "image_topic", "clock", "lidar_stamp_offset_s",
          "imu_stamp_offset_s", "imu_accel_unit", "point_time_unit", "full_intensity"})
      EXPECT_NE(text.find(std::string("\n") + key + " = "), std::string::npos) << entry.path() << ": " << key;
  }
  EXPECT_GE(rigs, 10);
}

TEST(BagRig, UnknownKeysAreErrors) {
  EXPECT_TRUE(parse_bag_rig("[replay]\nlidar_topic = \"/a\"\nclock = \"arrival\"\n", "r.toml"));
  const auto wrong = parse_bag_rig("[replay]\nlidar = \"/a\"\n", "r.toml");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, Errc::kInvalidConfig);
}

}  // namespace
}  // namespace edgesplat::replay
