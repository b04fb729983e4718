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

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
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
  if (!options.lidars.empty() && options.speed != 1.0) {
    return fail(Errc::kInvalidConfig, "a virtual LiDAR's clock knows no other --speed than 1");
  }
  if (!options.lidars.empty() && (options.faults.flip > 0.0 || options.faults.drop > 0.0)) {
    return fail(Errc::kInvalidConfig,
                "--flip-bits and --drop are for bare datagrams; see --lidar-fault loss@...");
  }
  const auto is_share = [](double rate) { return rate >= 0.0 && rate <= 1.0; };
  if (!is_share(options.faults.flip) || !is_share(options.faults.drop) || !is_share(options.gige_loss)) {
    return fail(Errc::kInvalidConfig, "--flip-bits, --drop and --camera-loss are shares in [0, 1]");
  }
  return {};
}

/// How many LiDARs the recording has: at least one, its topics are numbered.
std::size_t count_lidars(const io::McapReader& reader) {
  std::size_t count = 1;
  while (reader.find_channel(io::topic_of_lidar(io::kLidarPointsTopic, count)) != nullptr) ++count;
  return count;
}

Result<std::vector<LidarOutput>> open_lidars(const StreamOptions& options, std::size_t count,
                                             const Clock& clock) {
  if (!options.lidars.empty() && options.lidars.size() != count)
    return fail(Errc::kInvalidConfig, "the recording has " + std::to_string(count) +
                                          " LiDARs, --lidar names " + std::to_string(options.lidars.size()));
  std::vector<LidarOutput> lidars;
  for (std::size_t unit = 0; unit < count; ++unit) {
    EDGESPLAT_TRY(LidarOutput lidar, LidarOutput::open(options, unit, clock));
    lidars.push_back(std::move(lidar));
  }
  return lidars;
}

std::chrono::milliseconds seconds_to_ms(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * seconds));
}

// Hands each message of a recording to the device that sent it.
class Player {
 public:
  Player(std::vector<LidarOutput> lidars, std::unique_ptr<CameraEnd> camera)
      : lidars_(std::move(lidars)), camera_(std::move(camera)) {
    for (std::size_t unit = 0; unit < lidars_.size(); ++unit) {
      points_topics_.push_back(io::topic_of_lidar(io::kLidarPointsTopic, unit));
      imu_topics_.push_back(io::topic_of_lidar(io::kLidarImuTopic, unit));
    }
  }

  /// Those of the LiDARs.
  [[nodiscard]] std::vector<std::string> topics() const {
    std::vector<std::string> all = points_topics_;
    all.insert(all.end(), imu_topics_.begin(), imu_topics_.end());
    return all;
  }
  /// True when each was asked in time.
  bool wait_for_hosts(std::chrono::milliseconds timeout, const std::stop_token& stop) {
    bool all = true;
    for (LidarOutput& lidar : lidars_) all = lidar.wait_for_host(timeout, stop) && all;
    return all;
  }
  void begin(HostTime first) {
    for (LidarOutput& lidar : lidars_) lidar.begin(first);
  }
  bool wait_for_camera(std::chrono::milliseconds timeout, const std::stop_token& stop) {
    return camera_->wait_for_robot(timeout, stop);
  }
  void play(const io::McapMessage& message) {
    const std::string_view topic = message.channel->topic;
    bool good = true;
    if (const auto unit = index_of(points_topics_, topic)) {
      good = play_datagram(message, lidars_[*unit], &LidarOutput::points);
    } else if (const auto with_imu = index_of(imu_topics_, topic)) {
      good = play_datagram(message, lidars_[*with_imu], &LidarOutput::imu);
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
    for (const LidarOutput& lidar : lidars_) lidar.report(report);
    report.messages_skipped = skipped_;
  }

 private:
  static std::optional<std::size_t> index_of(const std::vector<std::string>& topics, std::string_view topic) {
    const auto found = std::ranges::find(topics, topic);
    if (found == topics.end()) return std::nullopt;
    return static_cast<std::size_t>(found - topics.begin());
  }
  bool play_datagram(const io::McapMessage& message, LidarOutput& lidar,
                     void (LidarOutput::*hand_on)(std::span<const std::byte>, HostTime)) {
    const auto raw = io::decode_raw_datagram(message.payload);
    if (!raw) return false;
    (lidar.*hand_on)(raw->datagram, message.log_time);
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

  std::vector<LidarOutput> lidars_;  ///< by unit
  std::vector<std::string> points_topics_;
  std::vector<std::string> imu_topics_;
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
  EDGESPLAT_TRY(auto lidars, open_lidars(options, count_lidars(reader), clock));
  EDGESPLAT_TRY(auto camera, open_camera(options, clock));
  Player player(std::move(lidars), std::move(camera));

  StreamReport report;
  if (reader.find_channel(io::kCameraImageTopic) != nullptr) {
    report.camera_connected = player.wait_for_camera(seconds_to_ms(options.wait_for_camera_s), stop);
  }
  std::vector<std::string> topics = player.topics();
  topics.emplace_back(io::kCameraMetaTopic);
  topics.emplace_back(io::kCameraImageTopic);
  reader.select({.topics = std::move(topics)});
  report.lidar_asked = player.wait_for_hosts(seconds_to_ms(options.wait_for_lidar_s), stop);
  Pacer pacer(options.speed);
  bool begun = false;
  while (const auto message = reader.next()) {
    if (!pacer.wait_for(message->log_time, stop)) {
      report.stopped = true;
      break;
    }
    if (!std::exchange(begun, true)) player.begin(message->log_time);
    player.play(*message);
  }
  player.finish(report);
  report.late = pacer.late();
  report.most_late = pacer.most_late();
  report.recording_problem = reader.report().why;
  return report;
}

}  // namespace edgesplat::virtual_device
