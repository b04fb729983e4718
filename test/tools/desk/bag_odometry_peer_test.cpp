// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// ROS bags written by PyPI's rosbags from a simulated recording must be tracked as the recording itself.
#include "common/base/bytes.hpp"
#include "common/io/image_file.hpp"
#include "robot/drivers/replay/replay_source.hpp"
#include "test/support/child_process.hpp"
#include "test/support/temp_dir.hpp"
#include "tools/desk/odometry.hpp"
#include "tools/simulate/simulator.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace edgesplat::desk {
namespace {

namespace fs = std::filesystem;

/// Measurements in the layout that bag_writer.py describes. Packets of 0.5 ms are gathered to sweeps as ROS
/// drivers do, at their ends.
class MeasurementList {
 public:
  void add(const sensor::LidarPacket& packet) {
    constexpr auto kSweep = std::chrono::milliseconds(100);
    if (sweep_points_ > 0 && packet.stamp - sweep_stamp_ >= kSweep) end_sweep();
    if (sweep_points_ == 0) sweep_stamp_ = packet.stamp;
    sweep_arrival_ = packet.arrival;
    for (const sensor::LidarPoint& point : packet.points) {
      sweep_.write(static_cast<std::uint32_t>((packet.stamp - sweep_stamp_).count() + point.offset_ns));
      for (int axis = 0; axis < 3; ++axis) sweep_.write(point.p_in_lidar_m[axis]);
      sweep_.write(static_cast<std::uint8_t>(std::lround(255.0F * point.reflectivity)));
      sweep_.write(point.noise_class);  // an SDK2 tag of 1: medium confidence
      sweep_.write(point.line);
      sweep_.write(std::uint8_t{0});
      ++sweep_points_;
    }
  }
  void add(const sensor::ImuSample& sample) {
    ByteWriter content;
    for (int axis = 0; axis < 3; ++axis) content.write(sample.gyro_radps[axis]);
    for (int axis = 0; axis < 3; ++axis) content.write(sample.accel_mps2[axis]);
    append(1, sample.arrival, sample.stamp, content.bytes());
  }
  void add(const sensor::CameraFrame& frame) {
    const auto png = io::encode_png(*frame.image).value();
    ByteWriter content;
    content.write(static_cast<std::uint32_t>(frame.image->width_px));
    content.write(static_cast<std::uint32_t>(frame.image->height_px));
    content.write(static_cast<std::uint32_t>(png.size()));
    content.write_bytes(png);
    content.write_bytes(std::as_bytes(std::span(frame.image->values)));
    append(2, frame.arrival, frame.stamp, content.bytes());
  }
  void add(const sensor::LidarScan&) {}
  [[nodiscard]] std::vector<std::byte> take() {
    end_sweep();
    return out_.take();
  }

 private:
  void end_sweep() {
    if (sweep_points_ > 0) append(0, sweep_arrival_, sweep_stamp_, sweep_.bytes());
    sweep_.clear();
    sweep_points_ = 0;
  }
  void append(std::uint8_t kind, HostTime arrival, SensorTime stamp, std::span<const std::byte> content) {
    out_.write(kind);
    out_.write(to_ns(arrival));
    out_.write(to_ns(stamp));
    out_.write(static_cast<std::uint32_t>(content.size()));
    out_.write_bytes(content);
  }
  ByteWriter out_;
  ByteWriter sweep_;
  int sweep_points_ = 0;
  SensorTime sweep_stamp_{};
  HostTime sweep_arrival_{};
};

class BagOdometryPeer : public ::testing::Test {
 protected:
  void simulate() {
    simulate::SimulateOptions options;
    options.world.seed = 7;
    options.seconds = 4.0;
    options.camera_width_px = 64;
    options.camera_height_px = 48;
    options.out = recording_;
    ASSERT_TRUE(simulate::simulate(options, {}, {}));
    auto source = replay::ReplaySource::open(recording_);
    ASSERT_TRUE(source) << source.error().context;
    rig_.rig = source->rig();
    MeasurementList list;
    while (true) {
      const auto measurement = source->next();
      ASSERT_TRUE(measurement);
      if (!*measurement) break;
      std::visit([&](const auto& one) { list.add(one); }, **measurement);
    }
    folder_.write("measurements", list.take());
  }
  /// The exit code of bag_writer.py, or nothing without the peers' Python.
  [[nodiscard]] std::optional<int> write_bags() const {
    const char* chosen = std::getenv("EDGESPLAT_PEERS_PYTHON");
    const std::string python = chosen != nullptr ? chosen : EDGESPLAT_SOURCE_DIR "/.deps/peers/bin/python";
    if (!fs::exists(python)) return std::nullopt;
    return test::ChildProcess({python, EDGESPLAT_SOURCE_DIR "/test/tools/desk/bag_writer.py",
                               (folder_ / "measurements").string(), folder_.path().string()})
        .wait(std::chrono::minutes(10));
  }
  [[nodiscard]] OdometryRun track(const fs::path& path, OdometryMode mode) const {
    OdometryJob job;
    job.lidar = path;
    job.mode = mode;
    if (path != recording_) job.rig = rig_;
    const SteadyClock clock;
    auto run = run_odometry(job, clock, clock);
    EXPECT_TRUE(run) << path << ": " << run.error().context;
    return run ? *std::move(run) : OdometryRun();
  }

  test::TempDir folder_;
  fs::path recording_ = folder_ / "ours.mcap";
  replay::BagRig rig_;
};

TEST_F(BagOdometryPeer, EveryKindOfBagIsTrackedAsOurOwnRecording) {
  simulate();
  if (HasFatalFailure()) return;
  const std::optional<int> code = write_bags();
  constexpr int kMissingPackage = 77;
  if (!code || code == kMissingPackage) GTEST_SKIP() << "no Python with rosbags: run tools/setup --peers";
  ASSERT_EQ(*code, 0);
  const OdometryRun ours = track(recording_, OdometryMode::kLidarInertial);
  ASSERT_GT(ours.poses.size(), 20U);
  for (const char* bag : {"custom_none.bag", "custom_bz2.bag", "custom_lz4.bag", "cloud.bag", "sqlite",
                          "mcap", "packed", "messages"}) {
    const OdometryRun theirs = track(folder_ / bag, OdometryMode::kLidarInertial);
    ASSERT_EQ(theirs.poses.size(), ours.poses.size()) << bag;
    double furthest_m = 0.0;
    for (std::size_t i = 0; i < ours.poses.size(); ++i) {
      EXPECT_EQ(theirs.poses[i].stamp, ours.poses[i].stamp) << bag << " " << i;
      const auto& a = ours.poses[i].world_from_body;
      const auto& b = theirs.poses[i].world_from_body;
      furthest_m = std::max(furthest_m, (a.translation_m - b.translation_m).norm());
    }
    EXPECT_LT(furthest_m, 1e-9) << bag;
    RecordProperty(std::string(bag) + "_furthest_m", std::to_string(furthest_m));
  }
  // A bag does not say how long a picture was exposed, so the visual update cannot be the same to the bit.
  const OdometryRun with_pictures = track(recording_, OdometryMode::kLidarInertialVisual);
  const OdometryRun bag_with_pictures = track(folder_ / "cloud.bag", OdometryMode::kLidarInertialVisual);
  ASSERT_EQ(bag_with_pictures.poses.size(), with_pictures.poses.size());
  for (std::size_t i = 0; i < with_pictures.poses.size(); ++i)
    EXPECT_LT((with_pictures.poses[i].world_from_body.translation_m -
               bag_with_pictures.poses[i].world_from_body.translation_m)
                  .norm(),
              0.02);
}

}  // namespace
}  // namespace edgesplat::desk
