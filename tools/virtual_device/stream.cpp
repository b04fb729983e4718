// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/stream.hpp"

#include "common/io/image_file.hpp"
#include "common/io/mcap_reader.hpp"
#include "common/io/recording_topics.hpp"
#include "common/io/ros_messages.hpp"
#include "tools/virtual_device/camera_end.hpp"
#include "tools/virtual_device/datagram_sender.hpp"
#include "tools/virtual_device/pacer.hpp"

#include <chrono>
#include <memory>
#include <optional>
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
  const auto is_share = [](double rate) { return rate >= 0.0 && rate <= 1.0; };
  if (!is_share(options.faults.flip) || !is_share(options.faults.drop) || !is_share(options.gige_loss)) {
    return fail(Errc::kInvalidConfig, "--flip-bits, --drop and --camera-loss are shares in [0, 1]");
  }
  return {};
}

// Hands each message of a recording to the device that sent it.
class Player {
 public:
  Player(const StreamOptions& options, DatagramSender points, DatagramSender imu,
         std::unique_ptr<CameraEnd> camera)
      : points_(std::move(points)),
        imu_(std::move(imu)),
        camera_(std::move(camera)),
        faults_(options.faults, options.seed) {}

  bool wait_for_camera(std::chrono::milliseconds timeout, const std::stop_token& stop) {
    return camera_->wait_for_robot(timeout, stop);
  }
  void play(const io::McapMessage& message) {
    const std::string_view topic = message.channel->topic;
    bool good = true;
    if (topic == io::kLidarPointsTopic) {
      good = play_datagram(points_, message.payload);
    } else if (topic == io::kLidarImuTopic) {
      good = play_datagram(imu_, message.payload);
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
    report.points_sent = points_.sent();
    report.imu_sent = imu_.sent();
    report.refused = points_.refused() + imu_.refused();
    report.flipped = faults_.flipped();
    report.dropped = faults_.dropped();
    report.messages_skipped = skipped_;
  }

 private:
  bool play_datagram(DatagramSender& sender, std::span<const std::byte> payload) {
    const auto raw = io::decode_raw_datagram(payload);
    if (!raw) return false;
    scratch_.assign(raw->datagram.begin(), raw->datagram.end());
    if (faults_.pass(scratch_)) sender.send(scratch_);
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

  DatagramSender points_;
  DatagramSender imu_;
  std::unique_ptr<CameraEnd> camera_;
  FaultInjector faults_;
  std::optional<io::FrameMeta> meta_;
  std::uint32_t next_sequence_ = 0;
  std::uint64_t skipped_ = 0;
  std::vector<std::byte> scratch_;
};

}  // namespace

Result<StreamReport> stream_recording(const StreamOptions& options, const std::stop_token& stop) {
  EDGESPLAT_TRY_STATUS(check_options(options));
  EDGESPLAT_TRY(io::McapReader reader, io::McapReader::open(options.recording));
  EDGESPLAT_TRY(DatagramSender points, DatagramSender::open(options.to, options.points_port));
  EDGESPLAT_TRY(DatagramSender imu, DatagramSender::open(options.to, options.imu_port));
  const SteadyClock clock;
  EDGESPLAT_TRY(auto camera, open_camera(options, clock));
  Player player(options, std::move(points), std::move(imu), std::move(camera));

  StreamReport report;
  if (reader.find_channel(io::kCameraImageTopic) != nullptr) {
    const std::chrono::milliseconds timeout(static_cast<std::int64_t>(1e3 * options.wait_for_camera_s));
    report.camera_connected = player.wait_for_camera(timeout, stop);
  }
  reader.select({.topics = {std::string(io::kLidarPointsTopic), std::string(io::kLidarImuTopic),
                            std::string(io::kCameraMetaTopic), std::string(io::kCameraImageTopic)}});
  Pacer pacer(options.speed);
  while (const auto message = reader.next()) {
    if (!pacer.wait_for(message->log_time, stop)) {
      report.stopped = true;
      break;
    }
    player.play(*message);
  }
  player.finish(report);
  report.late = pacer.late();
  report.most_late = pacer.most_late();
  report.recording_problem = reader.report().why;
  return report;
}

}  // namespace edgesplat::virtual_device
