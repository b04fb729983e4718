// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/simulator.hpp"

#include "common/io/atomic_file.hpp"
#include "common/io/image_file.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/io/recording_topics.hpp"
#include "common/io/ros_messages.hpp"
#include "common/io/trajectory_file.hpp"
#include "common/sensor/rig_config.hpp"
#include "tools/simulate/trajectory.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>

namespace edgesplat::simulate {
namespace {

class SimulatorTest : public testing::Test {
 protected:
  SimulatorTest() {
    folder_ = std::filesystem::temp_directory_path() /
              ("simulator_test_" + std::to_string(::getpid()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  ~SimulatorTest() override { std::filesystem::remove_all(folder_); }

  SimulateOptions options(const char* name) const {
    SimulateOptions out;
    out.world.pedestrians = 2;
    out.world.seed = 7;
    out.seconds = 1.0;
    out.camera_width_px = 64;
    out.camera_height_px = 48;
    out.out = folder_ / name;
    return out;
  }
  std::filesystem::path folder_;
};

TEST_F(SimulatorTest, RecordingHoldsEveryTopicAtItsRate) {
  const SimulateOptions options = this->options("rec.mcap");
  double last_s = 0.0;
  const auto report = simulate(options, [&](double s) { last_s = s; }, {});
  ASSERT_TRUE(report.has_value()) << report.error().context;
  EXPECT_DOUBLE_EQ(last_s, 1.0);
  EXPECT_EQ(report->point_packets, 2083U);  // 200 000 points / 96
  EXPECT_EQ(report->imu_packets, 200U);
  EXPECT_EQ(report->frames, 10U);

  auto reader = io::McapReader::open(options.out);
  ASSERT_TRUE(reader.has_value()) << reader.error().context;
  std::map<std::string, int> counts;
  HostTime last_arrival{};
  while (const auto message = reader->next()) {
    ++counts[message->channel->topic];
    EXPECT_GE(message->log_time, last_arrival);
    last_arrival = message->log_time;
  }
  EXPECT_TRUE(reader->report().complete) << reader->report().why;
  const std::map<std::string, int> expected = {
      {"/lidar/points_raw", 2083}, {"/lidar/imu_raw", 200},     {"/camera/meta", 10},
      {"/camera/image", 10},       {"/truth/body_pose", 200},   {"/truth/camera_clean", 10},
      {"/truth/camera_mask", 10},  {"/truth/camera_depth", 10},
  };
  EXPECT_EQ(counts, expected);
}

TEST_F(SimulatorTest, MetaPrecedesItsImageAndTheTruthHasItsSize) {
  const SimulateOptions options = this->options("rec.mcap");
  ASSERT_TRUE(simulate(options, {}, {}).has_value());
  auto reader = io::McapReader::open(options.out);
  ASSERT_TRUE(reader.has_value());
  SensorTime announced{};
  int pictures = 0;
  while (const auto message = reader->next()) {
    const std::string_view topic = message->channel->topic;
    if (topic == io::kCameraMetaTopic) {
      const auto meta = io::decode_frame_meta(message->payload);
      ASSERT_TRUE(meta.has_value());
      EXPECT_EQ(meta->stamp_source, sensor::StampSource::kPtp);
      EXPECT_GT(meta->exposure_s, 1e-4F);
      announced = meta->stamp;
    } else if (topic.find("camera") != std::string_view::npos) {
      const auto picture = io::decode_compressed_image(message->payload);
      ASSERT_TRUE(picture.has_value());
      EXPECT_EQ(picture->stamp, announced) << topic;
      const auto header = io::read_image_header(picture->encoded);
      ASSERT_TRUE(header.has_value());
      EXPECT_EQ(header->width_px, 64);
      EXPECT_EQ(header->height_px, 48);
      EXPECT_EQ(picture->format, topic == io::kCameraImageTopic ? "jpeg" : "png");
      ++pictures;
    }
  }
  EXPECT_EQ(pictures, 40);
}

TEST_F(SimulatorTest, TruthIsTheTrajectoryAndTheRigReadsBack) {
  const SimulateOptions options = this->options("rec.mcap");
  ASSERT_TRUE(simulate(options, {}, {}).has_value());
  auto reader = io::McapReader::open(options.out);
  ASSERT_TRUE(reader.has_value());
  const auto rig_file = reader->attachment(io::kRigAttachment);
  ASSERT_TRUE(rig_file.has_value());
  const std::string text(reinterpret_cast<const char*>(rig_file->content.data()), rig_file->content.size());
  const auto rig = sensor::parse_rig(text, "rig.toml");
  ASSERT_TRUE(rig.has_value()) << rig.error().context;
  EXPECT_NEAR(rig->body_from_lidar.translation_m.z(), 0.04412, 1e-9);
  ASSERT_TRUE(rig->camera.has_value());
  EXPECT_TRUE(rig->camera->model.validate());
  ASSERT_TRUE(reader->attachment(io::kWorldAttachment).has_value());

  TrajectoryConfig config;
  config.duration_s = options.seconds;
  config.seed = options.world.seed;
  const auto trajectory = Trajectory::create((*World::create(options.world))->path(), config);
  reader->select({.topics = {std::string(io::kTruthBodyPoseTopic)}});
  while (const auto message = reader->next()) {
    const auto pose = io::decode_pose_stamped(message->payload);
    ASSERT_TRUE(pose.has_value());
    const double time_s = to_seconds(pose->stamp - host_time_from_ns(kEpoch_ns));
    const auto truth = trajectory->world_from_body(time_s);
    EXPECT_LT((pose->frame_from_body.translation_m - truth.translation_m).norm(), 1e-6);
  }
}

TEST_F(SimulatorTest, SameSeedSameBytesOtherSeedOthers) {
  SimulateOptions first = options("first.mcap"), second = options("second.mcap"),
                  other = options("other.mcap");
  first.seconds = second.seconds = other.seconds = 0.3;
  other.world.seed = 8;
  for (const auto& run : {first, second, other}) ASSERT_TRUE(simulate(run, {}, {}).has_value());
  const auto bytes = [](const SimulateOptions& run) { return *io::read_file(run.out, 100 << 20); };
  EXPECT_TRUE(bytes(first) == bytes(second));
  EXPECT_FALSE(bytes(first) == bytes(other));
}

TEST_F(SimulatorTest, CleanViewsNeedNoRecording) {
  SimulateOptions options = this->options("");
  options.out.clear();
  const std::vector<io::StampedPose> poses(2, {HostTime{}, {Eigen::Quaterniond::Identity(), {0, 0, 0.6}}});
  ASSERT_TRUE(io::write_tum(folder_ / "poses.tum", poses).has_value());
  options.clean_views = CleanViews{folder_ / "poses.tum", folder_ / "clean"};
  ASSERT_TRUE(simulate(options, {}, {}).has_value());
  const auto picture = io::load_rgb8(folder_ / "clean" / "000001.png");
  ASSERT_TRUE(picture.has_value()) << picture.error().context;
  EXPECT_EQ(picture->width_px, 64);
}

TEST_F(SimulatorTest, StopLeavesAWholeRecording) {
  const SimulateOptions options = this->options("rec.mcap");
  std::stop_source stop;
  const auto report = simulate(
      options,
      [&](double simulated_s) {
        if (simulated_s > 0.25) stop.request_stop();
      },
      stop.get_token());
  ASSERT_TRUE(report.has_value());
  EXPECT_TRUE(report->stopped);
  EXPECT_EQ(report->frames, 3U);
  auto reader = io::McapReader::open(options.out);
  ASSERT_TRUE(reader.has_value());
  while (reader->next()) {
  }
  EXPECT_TRUE(reader->report().complete);
}

TEST_F(SimulatorTest, RefusesOptionsOutOfRange) {
  const auto code_of = [](const SimulateOptions& run) { return simulate(run, {}, {}).error().code; };
  SimulateOptions wrong = options("rec.mcap");
  wrong.seconds = 0.0;
  EXPECT_EQ(code_of(wrong), Errc::kInvalidConfig);
  wrong = options("rec.mcap");
  wrong.camera_width_px = 0;
  EXPECT_EQ(code_of(wrong), Errc::kInvalidConfig);
  wrong = options("rec.mcap");
  wrong.world.name = "moon";
  EXPECT_EQ(code_of(wrong), Errc::kInvalidConfig);
}

}  // namespace
}  // namespace edgesplat::simulate
