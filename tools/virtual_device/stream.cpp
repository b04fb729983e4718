// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/stream.hpp"

#include "common/io/image_file.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/io/recording_topics.hpp"
#include "common/io/ros_messages.hpp"
#include "common/time/clock.hpp"
#include "tools/virtual_device/camera_end.hpp"
#include "tools/virtual_device/lidar_output.hpp"
#include "tools/virtual_device/pacer.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace edgesplat::virtual_device {
namespace {

Status check_options(const StreamOptions& options) {
  if (!(options.speed > 0.0 && options.speed <= 100.0)) {
    return fail(Errc::kInvalidConfig, "--speed must be in (0, 100]");
  }
  if (!(options.wait_for_camera_s >= 0.0 && options.wait_for_camera_s <= 3600.0)) {
    return fail(Errc::kInvalidConfig, "--wait-for-camera must be in [0, 3600] s");
  }
  if (!(options.wait_for_lidar_s >= 0.0 && options.wait_for_lidar_s <= 3600.0)) {
    return fail(Errc::kInvalidConfig, "--wait-for-lidar must be in [0, 3600] s");
  }
  if (options.lidar && options.speed != 1.0) {
    return fail(Errc::kInvalidConfig, "a virtual LiDAR's clock knows no other --speed than 1");
  }
  if (options.lidar && (options.faults.flip > 0.0 || options.faults.drop > 0.0)) {
    return fail(Errc::kInvalidConfig,
                "--flip-bits and --drop are for bare datagrams; see --lidar-fault loss@...");
  }
  const auto is_share = [](double rate) { return rate >= 0.0 && rate <= 1.0; };
  if (!is_share(options.faults.flip) || !is_share(options.faults.drop) || !is_share(options.gige_loss)) {
    return fail(Errc::kInvalidConfig, "--flip-bits, --drop and --camera-loss are shares in [0, 1]");
  }
  return {};
}

std::chrono::milliseconds seconds_to_ms(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * seconds));
}

// Hands each message of a recording to the device that sent it.
class Player {
 public:
  Player(LidarOutput lidar, std::unique_ptr<CameraEnd> camera)
      : lidar_(std::move(lidar)), camera_(std::move(camera)) {}

  LidarOutput& lidar() { return lidar_; }
  bool wait_for_camera(std::chrono::milliseconds timeout, const std::stop_token& stop) {
    return camera_->wait_for_robot(timeout, stop);
  }
  void play(const io::McapMessage& message) {
    const std::string_view topic = message.channel->topic;
    bool good = true;
    if (topic == io::kLidarPointsTopic) {
      good = play_datagram(message, &LidarOutput::points);
    } else if (topic == io::kLidarImuTopic) {
      good = play_datagram(message, &LidarOutput::imu);
    } else if (topic == io::kCameraMetaTopic) {
      const auto meta = io::decode_frame_meta(message.payload);
      good = meta.has_value();
      if (meta) meta_ = *meta;
    } else if (topic == io::kCameraImageTopic) {
      good = play_image(message.payload);
    }
    if (!good) ++skipped_;
  }
  void finish(StreamReport& report) {
    camera_->finish(report);
    lidar_.report(report);
    report.messages_skipped = skipped_;
  }

 private:
  bool play_datagram(const io::McapMessage& message,
                     void (LidarOutput::*hand_on)(std::span<const std::byte>, HostTime)) {
    const auto raw = io::decode_raw_datagram(message.payload);
    if (!raw) return false;
    (lidar_.*hand_on)(raw->datagram, message.log_time);
    return true;
  }
  bool play_image(std::span<const std::byte> payload) {
    const auto image = io::decode_compressed_image(payload);
    if (!image) return false;
    const auto header = io::read_image_header(image->encoded);
    if (!header) return false;
    FrameMessage frame;
    frame.stamp = image->stamp;
    frame.format = header->format == io::ImageFormat::kPng ? FrameFormat::kPng : FrameFormat::kJpeg;
    frame.width_px = static_cast<std::uint16_t>(header->width_px);
    frame.height_px = static_cast<std::uint16_t>(header->height_px);
    frame.sequence = next_sequence_;
    if (meta_ && meta_->stamp == image->stamp) {
      frame.sequence = meta_->sequence;
      frame.exposure_s = meta_->exposure_s;
      frame.gain_db = meta_->gain_db;
      frame.stamp_source = meta_->stamp_source;
    }
    next_sequence_ = frame.sequence + 1;
    camera_->push(frame, {image->encoded.begin(), image->encoded.end()});
    return true;
  }

  LidarOutput lidar_;
  std::unique_ptr<CameraEnd> camera_;
  std::optional<io::FrameMeta> meta_;
  std::uint32_t next_sequence_ = 0;
  std::uint64_t skipped_ = 0;
};

}  // namespace

Result<StreamReport> stream_recording(const StreamOptions& options, const std::stop_token& stop) {
  EDGESPLAT_TRY_STATUS(check_options(options));
  EDGESPLAT_TRY(io::McapReader reader, io::McapReader::open(options.recording));
  const SteadyClock clock;
  EDGESPLAT_TRY(LidarOutput lidar, LidarOutput::open(options, clock));
  EDGESPLAT_TRY(auto camera, open_camera(options, clock));
  Player player(std::move(lidar), std::move(camera));

  StreamReport report;
  if (reader.find_channel(io::kCameraImageTopic) != nullptr) {
    report.camera_connected = player.wait_for_camera(seconds_to_ms(options.wait_for_camera_s), stop);
  }
  reader.select({.topics = {std::string(io::kLidarPointsTopic), std::string(io::kLidarImuTopic),
                            std::string(io::kCameraMetaTopic), std::string(io::kCameraImageTopic)}});
  report.lidar_asked = player.lidar().wait_for_host(seconds_to_ms(options.wait_for_lidar_s), stop);
  Pacer pacer(options.speed);
  bool begun = false;
  while (const auto message = reader.next()) {
    if (!pacer.wait_for(message->log_time, stop)) {
      report.stopped = true;
      break;
    }
    if (!std::exchange(begun, true)) player.lidar().begin(message->log_time);
    player.play(*message);
  }
  player.finish(report);
  report.late = pacer.late();
  report.most_late = pacer.most_late();
  report.recording_problem = reader.report().why;
  return report;
}

}  // namespace edgesplat::virtual_device
