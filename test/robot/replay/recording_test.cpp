// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/image_file.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/sensor/rig_config.hpp"
#include "robot/drivers/replay/recorder.hpp"
#include "robot/drivers/replay/replay_source.hpp"
#include "test/robot/livox/packet_bytes.hpp"
#include "test/robot/livox/sdk1_bytes.hpp"
#include "test/support/temp_dir.hpp"

#include <gtest/gtest.h>

#include <array>
#include <thread>

namespace edgesplat::replay {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kArrival_ns = 5'000 * kMs;

sensor::Rig small_rig() {
  sensor::Rig rig;
  rig.name = "test";
  rig.imu.emplace();
  rig.camera.emplace();
  rig.camera->model = {geometry::CameraKind::kPinhole, 16, 12, 16.0, 16.0, 7.5, 5.5, {}};
  return rig;
}

std::vector<std::byte> point_datagram(int index) {
  livox::PacketFields fields;
  fields.udp_count = static_cast<std::uint16_t>(index);
  fields.stamp_ns = static_cast<std::uint64_t>(kStart_ns + index * kMs);
  livox::append_point_mm(fields.records, 1000 + index, 2000, 3000);
  return livox::packet_bytes(fields);
}

std::vector<std::byte> imu_datagram(int index) {
  livox::PacketFields fields;
  fields.type = 0;
  fields.udp_count = static_cast<std::uint16_t>(index);
  fields.stamp_ns = static_cast<std::uint64_t>(kStart_ns + index * kMs);
  const std::array<float, 6> values{0.1F, 0, 0, 0, 0, 1};
  fields.records = livox::imu_record(values);
  return livox::packet_bytes(fields);
}

frame_socket::EncodedFrame camera_frame(int index, int width = 16) {
  frame_socket::EncodedFrame frame;
  frame.payload = io::encode_png(sensor::ImageRgb8(width, 12, static_cast<std::uint8_t>(index))).value();
  frame.header.payload_bytes = static_cast<std::uint32_t>(frame.payload.size());
  frame.header.sequence = static_cast<std::uint32_t>(index);
  frame.header.stamp = sensor_time_from_ns(kStart_ns + index * kMs + 123);  // ns that 32-bit fields would cut
  frame.header.exposure_s = 0.004F;
  frame.header.gain_db = 2.0F;
  frame.header.stamp_source = sensor::StampSource::kPtp;
  frame.header.format = frame_socket::PictureFormat::kPng;
  return frame;
}

HostTime arrival_of(int index) {
  return host_time_from_ns(kArrival_ns + index * kMs);
}

/// 300 ms: points each ms, IMU each 5 ms, pictures each 100 ms.
void record(Recorder& recorder) {
  for (int index = 0; index < 300; ++index) {
    const auto points = point_datagram(index);
    recorder.on_datagram({livox::Channel::kPoints, arrival_of(index), points});
    if (index % 5 == 0) {
      const auto imu = imu_datagram(index);
      recorder.on_datagram({livox::Channel::kImu, arrival_of(index), imu});
    }
    if (index % 100 == 0) recorder.on_frame(camera_frame(index), arrival_of(index), arrival_of(index));
  }
}

std::filesystem::path write_recording(const test::TempDir& folder) {
  auto path = folder.path() / "run.mcap";
  auto recorder = Recorder::create(path, sensor::print_rig(small_rig()), "");
  EXPECT_TRUE(recorder.has_value()) << recorder.error().context;
  std::jthread writing([&recorder](const std::stop_token& stop) {
    while ((*recorder)->write_next(stop).value()) {
    }
  });
  record(**recorder);
  writing.request_stop();
  writing.join();
  EXPECT_TRUE((*recorder)->finish().has_value());
  EXPECT_EQ((*recorder)->counters().written, 363U);
  EXPECT_EQ((*recorder)->counters().dropped, 0U);
  return path;
}

struct Counts {
  std::size_t packets = 0;
  std::size_t samples = 0;
  std::size_t frames = 0;
};

Counts count_all(ReplaySource& source) {
  Counts counts;
  HostTime latest{};
  while (true) {
    auto next = source.next();
    EXPECT_TRUE(next.has_value());
    if (!next || !*next) return counts;
    counts.packets += std::holds_alternative<sensor::LidarPacket>(**next) ? 1U : 0U;
    counts.samples += std::holds_alternative<sensor::ImuSample>(**next) ? 1U : 0U;
    counts.frames += std::holds_alternative<sensor::CameraFrame>(**next) ? 1U : 0U;
    const HostTime arrival = std::visit([](const auto& one) { return one.arrival; }, **next);
    EXPECT_GE(arrival, latest) << "not in order of arrival";
    latest = arrival;
  }
}

TEST(Recording, WhatWasRecordedIsReplayed) {
  const test::TempDir folder;
  auto source = ReplaySource::open(write_recording(folder));
  ASSERT_TRUE(source.has_value()) << source.error().context;
  EXPECT_EQ(source->rig().camera->model.width_px, 16);
  EXPECT_TRUE(source->rig().imu.has_value());
  EXPECT_EQ(source->duration(), nanoseconds(299 * kMs));
  EXPECT_EQ(source->begin(), arrival_of(0));
  const Counts counts = count_all(*source);
  EXPECT_EQ(counts.packets, 300U);
  EXPECT_EQ(counts.samples, 60U);
  EXPECT_EQ(counts.frames, 3U);
  EXPECT_TRUE(source->report().complete) << source->report().why;
}

// A camera's lost packets came again 150 ms later: live the picture met the points of then, and a replay that
// showed it earlier would find other groups.
TEST(Recording, APictureThatCameLateIsReplayedAmongThePointsItCameAmong) {
  const test::TempDir folder;
  const auto path = folder.path() / "late.mcap";
  auto recorder = Recorder::create(path, sensor::print_rig(small_rig()), "");
  ASSERT_TRUE(recorder.has_value()) << recorder.error().context;
  for (int index = 0; index < 300; ++index) {
    const auto points = point_datagram(index);
    (*recorder)->on_datagram({livox::Channel::kPoints, arrival_of(index), points});
    if (index == 250) (*recorder)->on_frame(camera_frame(100), arrival_of(100), arrival_of(250));
  }
  ASSERT_TRUE((*recorder)->finish().has_value());
  auto source = ReplaySource::open(path);
  ASSERT_TRUE(source.has_value()) << source.error().context;
  int packets_before = 0;
  while (true) {
    const auto next = source->next();
    ASSERT_TRUE(next.has_value() && next->has_value()) << "the picture is missing";
    if (std::holds_alternative<sensor::LidarPacket>(**next)) ++packets_before;
    const auto* frame = std::get_if<sensor::CameraFrame>(&**next);
    if (frame == nullptr) continue;
    EXPECT_EQ(frame->arrival, arrival_of(100));
    EXPECT_NEAR(packets_before, 250, 1);
    return;
  }
}

TEST(Recording, KeepsStampsAndPicturesExactly) {
  const test::TempDir folder;
  auto source = ReplaySource::open(write_recording(folder));
  ASSERT_TRUE(source.has_value());
  while (true) {
    const auto next = source->next();
    ASSERT_TRUE(next.has_value() && next->has_value());
    const auto* frame = std::get_if<sensor::CameraFrame>(&**next);
    if (frame == nullptr || frame->sequence != 200) continue;
    EXPECT_EQ(to_ns(frame->stamp), kStart_ns + 200 * kMs + 123);
    EXPECT_EQ(frame->arrival, arrival_of(200));
    EXPECT_FLOAT_EQ(frame->exposure_s, 0.004F);
    EXPECT_EQ(frame->stamp_source, sensor::StampSource::kPtp);
    EXPECT_EQ(frame->image->values.front(), 200);
    return;
  }
}

TEST(Recording, ATruncatedFileGivesWhatIsWhole) {
  const test::TempDir folder;
  const auto path = write_recording(folder);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) * 6 / 10);
  auto source = ReplaySource::open(path);
  if (!source) {  // one chunk alone was cut
    EXPECT_FALSE(source.error().context.empty());
    return;
  }
  (void)count_all(*source);
  EXPECT_FALSE(source->report().complete);
  EXPECT_FALSE(source->report().why.empty());
}

TEST(Recording, DamagedDatagramsAreCountedAndNotUsed) {
  const test::TempDir folder;
  const auto path = folder.path() / "damaged.mcap";
  auto recorder = Recorder::create(path, sensor::print_rig(small_rig()), "");
  ASSERT_TRUE(recorder.has_value());
  for (int index = 0; index < 10; ++index) {
    auto points = point_datagram(index);
    if (index == 3) points[40] ^= std::byte{1};
    if (index == 4) points.resize(20);
    (*recorder)->on_datagram({livox::Channel::kPoints, arrival_of(index), points});
  }
  (*recorder)->on_frame(camera_frame(5, 20), arrival_of(10), arrival_of(10));  // not the rig's size
  ASSERT_TRUE((*recorder)->finish().has_value());
  auto source = ReplaySource::open(path);
  ASSERT_TRUE(source.has_value()) << source.error().context;
  const Counts counts = count_all(*source);
  EXPECT_EQ(counts.packets, 8U);
  EXPECT_EQ(counts.frames, 0U);
  EXPECT_EQ(source->report().packets_refused, 2U);
  EXPECT_EQ(source->report().frames_refused, 1U);
  EXPECT_NE(source->report().why.find("20x12"), std::string::npos) << source->report().why;
}

TEST(Recording, WhatCameIsInTheFileSoonAlsoWhenNothingMoreComes) {
  const test::TempDir folder;
  const auto path = folder.path() / "run.mcap";
  auto recorder = Recorder::create(path, sensor::print_rig(small_rig()), "");
  ASSERT_TRUE(recorder.has_value());
  std::jthread writing([&recorder](const std::stop_token& stop) {
    while ((*recorder)->write_next(stop).value()) {
    }
  });
  for (int index = 0; index < 5; ++index) {
    const auto points = point_datagram(index);
    (*recorder)->on_datagram({livox::Channel::kPoints, arrival_of(index), points});
  }
  std::size_t seen = 0;
  for (int attempt = 0; attempt < 200 && seen < 5; ++attempt) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    auto source = ReplaySource::open(path);  // as if the recorder were killed now
    if (source) seen = count_all(*source).packets;
  }
  EXPECT_EQ(seen, 5U);
  writing.request_stop();
  writing.join();
  EXPECT_TRUE((*recorder)->finish().has_value());
}

TEST(Recording, ADiskThatGetsFullEndsItWhole) {
  const test::TempDir folder;
  const auto path = folder.path() / "run.mcap";
  RecorderConfig config;
  config.min_free_bytes = std::uint64_t{1} << 60U;  // no disk has as much
  auto recorder = Recorder::create(path, sensor::print_rig(small_rig()), "", config);
  ASSERT_TRUE(recorder.has_value());
  record(**recorder);
  std::vector<std::string> problems;
  const std::stop_source stop;
  for (int i = 0; i < 363; ++i) {
    const auto more = (*recorder)->write_next(stop.get_token());
    if (!more) problems.push_back(more.error().context);
  }
  ASSERT_EQ(problems.size(), 1U) << "said once";
  EXPECT_NE(problems.front().find("record.min_free_bytes"), std::string::npos) << problems.front();
  const auto finished = (*recorder)->finish();
  ASSERT_FALSE(finished.has_value());
  EXPECT_NE(finished.error().context.find("362 messages are not in it"), std::string::npos)
      << finished.error().context;
  EXPECT_EQ((*recorder)->counters().failed, 362U);
  auto source = ReplaySource::open(path);
  ASSERT_TRUE(source.has_value()) << source.error().context;
  EXPECT_EQ(count_all(*source).packets, 1U);
  EXPECT_TRUE(source->report().complete) << source->report().why;
}

/// What an Avia sends at a time: points, an IMU sample, an answer.
void feed_avia(Recorder& recorder, int index, std::size_t unit) {
  std::vector<std::byte> records;
  for (int i = 0; i < 96; ++i) livox::append_point_mm(records, 1000 + i, 2000, 3000);
  const auto imu = livox::imu_record(std::array<float, 6>{0.1F, 0, 0, 0, 0, 1});
  const auto stamp_ns = static_cast<std::uint64_t>(kStart_ns + index * 400'000);
  recorder.on_datagram(
      {livox::Channel::kPoints, arrival_of(index), livox::sdk1_packet(2, 1, stamp_ns, records)}, unit);
  recorder.on_datagram({livox::Channel::kImu, arrival_of(index), livox::sdk1_packet(6, 1, stamp_ns, imu)},
                       unit);
  recorder.on_datagram({livox::Channel::kControl, arrival_of(index), imu}, unit);
}

TEST(Recording, AnAviasPacketsAreReplayedAsSuch) {
  const test::TempDir folder;
  const auto path = folder.path() / "avia.mcap";
  RecorderConfig config;
  config.lidar_protocols = {livox::Protocol::kSdk1};
  auto recorder = Recorder::create(path, sensor::print_rig(small_rig()), "", config);
  ASSERT_TRUE(recorder.has_value());
  for (int index = 0; index < 10; ++index) feed_avia(**recorder, index, 0);
  ASSERT_TRUE((*recorder)->finish().has_value());
  auto source = ReplaySource::open(path);
  ASSERT_TRUE(source.has_value()) << source.error().context;
  const Counts counts = count_all(*source);
  EXPECT_EQ(counts.packets, 10U);
  EXPECT_EQ(counts.samples, 10U);
  EXPECT_TRUE(source->report().complete) << source->report().why;
}

TEST(Recording, SeveralLidarsHaveTopicsOfTheirOwn) {
  const test::TempDir folder;
  const auto path = folder.path() / "two.mcap";
  sensor::Rig rig = small_rig();
  rig.more_lidars.emplace_back();
  RecorderConfig config;
  config.lidar_protocols = {livox::Protocol::kSdk2, livox::Protocol::kSdk1};
  auto recorder = Recorder::create(path, sensor::print_rig(rig), "", config);
  ASSERT_TRUE(recorder.has_value());
  for (int index = 0; index < 10; ++index) {
    (*recorder)->on_datagram({livox::Channel::kPoints, arrival_of(index), point_datagram(index)});
    feed_avia(**recorder, index, 1);
  }
  ASSERT_TRUE((*recorder)->finish().has_value());
  auto reader = io::McapReader::open(path);
  ASSERT_TRUE(reader.has_value());
  for (const char* topic : {"/lidar/points_raw", "/lidar/imu_raw", "/lidar/control_raw"})
    EXPECT_EQ(reader->find_channel(topic)->metadata.at("protocol"), "livox_sdk2");
  for (const char* topic : {"/lidar1/points_raw", "/lidar1/imu_raw", "/lidar1/control_raw"})
    EXPECT_EQ(reader->find_channel(topic)->metadata.at("protocol"), "livox_sdk1");
  auto source = ReplaySource::open(path);
  ASSERT_TRUE(source.has_value()) << source.error().context;
  EXPECT_EQ(source->rig().lidar_count(), 2U);
  int packets[2] = {0, 0};
  int samples = 0;
  while (true) {
    const auto measurement = source->next();
    ASSERT_TRUE(measurement.has_value());
    if (!*measurement) break;
    if (const auto* packet = std::get_if<sensor::LidarPacket>(&**measurement)) ++packets[packet->unit];
    samples += std::holds_alternative<sensor::ImuSample>(**measurement) ? 1 : 0;
  }
  EXPECT_EQ(packets[0], 10);
  EXPECT_EQ(packets[1], 10);
  EXPECT_EQ(samples, 0) << "the body is the first one's IMU";
  EXPECT_TRUE(source->report().complete) << source->report().why;
}

TEST(Recording, NeedsItsRigAndItsTopics) {
  const test::TempDir folder;
  EXPECT_EQ(ReplaySource::open(folder.write("x.mcap", "no recording")).error().code, Errc::kCorrupt);
  const auto path = folder.path() / "bad_rig.mcap";
  auto recorder = Recorder::create(path, "[lidar]\nname = 5\n", "");
  ASSERT_TRUE(recorder.has_value());
  record(**recorder);
  ASSERT_TRUE((*recorder)->finish().has_value());
  const auto source = ReplaySource::open(path);
  ASSERT_FALSE(source.has_value());
  EXPECT_EQ(source.error().code, Errc::kInvalidConfig);
  EXPECT_NE(source.error().context.find("rig.toml"), std::string::npos) << source.error().context;

  auto empty = io::McapWriter::create(folder.path() / "empty.mcap");
  ASSERT_TRUE(empty.has_value() && empty->close().has_value());
  const auto no_topics = ReplaySource::open(folder.path() / "empty.mcap");
  EXPECT_EQ(no_topics.error().code, Errc::kInvalidArgument);
  EXPECT_NE(no_topics.error().context.find("/lidar/points_raw"), std::string::npos);
}

TEST(Recorder, AFullQueueDropsAndCounts) {
  const test::TempDir folder;
  RecorderConfig config;
  config.queue_items = 10;
  auto recorder = Recorder::create(folder.path() / "slow.mcap", sensor::print_rig(small_rig()), "", config);
  ASSERT_TRUE(recorder.has_value());
  record(**recorder);  // nobody writes
  ASSERT_TRUE((*recorder)->finish().has_value());
  EXPECT_EQ((*recorder)->counters().written, 10U);
  EXPECT_EQ((*recorder)->counters().dropped, 353U);
}

}  // namespace
}  // namespace edgesplat::replay
