// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/mcap_recording.hpp"

#include "common/io/image_file.hpp"
#include "common/io/recording_topics.hpp"
#include "common/io/ros_messages.hpp"
#include "common/sensor/rig_config.hpp"
#include "robot/drivers/livox/livox_source.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace edgesplat::replay {
namespace {

constexpr std::int64_t kLatest_ns = std::int64_t{1} << 62U;  // sums and differences of times stay in range

/// One of the rig's LiDARs in the recording.
struct RecordedLidar {
  std::string points_topic;
  livox::LivoxSource source;
};

class McapRecording final : public ReplaySource::Reader {
 public:
  McapRecording(io::McapReader reader, sensor::Rig rig, std::vector<RecordedLidar> lidars)
      : reader_(std::move(reader)), rig_(std::move(rig)), lidars_(std::move(lidars)) {}

  [[nodiscard]] const sensor::Rig& rig() const override { return rig_; }
  [[nodiscard]] nanoseconds duration() const override {
    return reader_.statistics().last_log_time - reader_.statistics().first_log_time;
  }
  [[nodiscard]] HostTime begin() const override { return reader_.statistics().first_log_time; }
  [[nodiscard]] ReplayReport report() const override;
  [[nodiscard]] Result<std::optional<sensor::Measurement>> next() override;

 private:
  [[nodiscard]] std::optional<sensor::Measurement> convert(const io::McapMessage& message);
  [[nodiscard]] std::optional<sensor::Measurement> convert_datagram(const io::McapMessage& message);
  void keep_meta(const io::McapMessage& message);
  [[nodiscard]] std::optional<sensor::Measurement> convert_image(const io::McapMessage& message);
  std::optional<sensor::Measurement> refuse_frame(std::string why);

  io::McapReader reader_;
  sensor::Rig rig_;
  std::vector<RecordedLidar> lidars_;  ///< by unit; the first one's IMU is the body's
  std::optional<io::FrameMeta> meta_;  ///< of the picture that comes next
  HostTime picture_arrival_{};         ///< of that picture; its own message tells when it was handed on
  std::uint64_t measurements_ = 0;
  std::uint64_t bad_messages_ = 0;
  std::uint64_t frames_refused_ = 0;
  std::string first_refusal_;
};

Result<std::optional<sensor::Measurement>> McapRecording::next() {
  while (const auto message = reader_.next()) {
    const bool sane = to_ns(message->log_time) >= 0 && to_ns(message->log_time) < kLatest_ns &&
                      to_ns(message->publish_time) > -kLatest_ns && to_ns(message->publish_time) < kLatest_ns;
    auto measurement = sane ? convert(*message) : std::nullopt;
    if (!sane) ++bad_messages_;
    if (!measurement) continue;
    ++measurements_;
    return measurement;
  }
  return std::nullopt;
}

std::optional<sensor::Measurement> McapRecording::convert(const io::McapMessage& message) {
  const std::string_view topic = message.channel->topic;
  if (topic == io::kCameraImageTopic) return convert_image(message);
  if (topic != io::kCameraMetaTopic) return convert_datagram(message);
  keep_meta(message);
  return std::nullopt;
}

std::optional<sensor::Measurement> McapRecording::convert_datagram(const io::McapMessage& message) {
  const auto raw = io::decode_raw_datagram(message.payload);
  if (!raw) {
    ++bad_messages_;
    return std::nullopt;
  }
  const std::string& topic = message.channel->topic;
  if (topic == io::kLidarImuTopic) return lidars_.front().source.on_imu(raw->datagram, message.log_time);
  const auto lidar = std::ranges::find(lidars_, topic, &RecordedLidar::points_topic);
  if (lidar == lidars_.end()) return std::nullopt;  // not selected
  return lidar->source.on_points(raw->datagram, message.log_time);
}

void McapRecording::keep_meta(const io::McapMessage& message) {
  const auto meta = io::decode_frame_meta(message.payload);
  meta_.reset();
  if (!meta) {
    ++bad_messages_;
    return;
  }
  meta_ = *meta;
  picture_arrival_ = message.log_time;
  meta_->stamp = message.publish_time;  // the message itself holds 32-bit seconds
}

std::optional<sensor::Measurement> McapRecording::convert_image(const io::McapMessage& message) {
  const auto meta = std::exchange(meta_, std::nullopt);
  if (!meta || meta->stamp != message.publish_time) return refuse_frame("a picture has no meta message");
  const auto compressed = io::decode_compressed_image(message.payload);
  if (!compressed) return refuse_frame(compressed.error().context);
  auto image = io::decode_rgb8(compressed->encoded);
  if (!image) return refuse_frame(image.error().context);
  if (rig_.camera &&
      (image->width_px != rig_.camera->model.width_px || image->height_px != rig_.camera->model.height_px))
    return refuse_frame("a picture is " + std::to_string(image->width_px) + "x" +
                        std::to_string(image->height_px) + " pixels, the camera in rig.toml " +
                        std::to_string(rig_.camera->model.width_px) + "x" +
                        std::to_string(rig_.camera->model.height_px));
  sensor::CameraFrame frame;
  frame.stamp = meta->stamp;
  frame.arrival = picture_arrival_;
  frame.stamp_source = meta->stamp_source;
  frame.sequence = meta->sequence;
  frame.exposure_s = meta->exposure_s;
  frame.gain_db = meta->gain_db;
  frame.image = std::make_shared<const sensor::ImageRgb8>(*std::move(image));
  return frame;
}

std::optional<sensor::Measurement> McapRecording::refuse_frame(std::string why) {
  ++frames_refused_;
  if (first_refusal_.empty()) first_refusal_ = std::move(why);
  return std::nullopt;
}

ReplayReport McapRecording::report() const {
  const io::McapReadReport& file = reader_.report();
  ReplayReport report;
  report.measurements = measurements_;
  report.bytes_skipped = file.bytes_skipped;
  report.packets_refused = bad_messages_;
  for (const RecordedLidar& recorded : lidars_) {
    const livox::LivoxCounters lidar = recorded.source.counters();
    report.packets_refused += lidar.bad_length + lidar.bad_version + lidar.bad_type + lidar.bad_crc +
                              lidar.bad_value + lidar.points.duplicate + lidar.points.bad_stamp +
                              lidar.imu.duplicate + lidar.imu.bad_stamp;
    report.points_dropped += lidar.dropped_points.no_return + lidar.dropped_points.low_confidence;
  }
  report.frames_refused = frames_refused_;
  report.why = file.why;
  const auto add = [&report](const std::string& why) {
    report.why += (report.why.empty() ? "" : "; ") + why;
  };
  if (report.packets_refused > 0) add(std::to_string(report.packets_refused) + " packets refused");
  if (frames_refused_ > 0) add(std::to_string(frames_refused_) + " pictures refused: " + first_refusal_);
  report.complete = report.why.empty();
  return report;
}

livox::Protocol protocol_of(const io::McapReader& reader, const std::string& points_topic) {
  const io::McapChannel* channel = reader.find_channel(points_topic);
  if (channel == nullptr) return livox::Protocol::kSdk2;
  const auto named = channel->metadata.find(std::string(io::kProtocolKey));
  const bool is_sdk1 = named != channel->metadata.end() && named->second == io::kLivoxSdk1;
  return is_sdk1 ? livox::Protocol::kSdk1 : livox::Protocol::kSdk2;
}

std::string list_topics(const io::McapReader& reader) {
  std::string text;
  for (const auto& [id, channel] : reader.channels()) text += (text.empty() ? "" : ", ") + channel.topic;
  return text.empty() ? "none" : text;
}

}  // namespace

bool is_own_recording(const io::McapReader& reader) {
  return reader.find_channel(io::kLidarPointsTopic) != nullptr ||
         reader.find_channel(io::kCameraImageTopic) != nullptr;
}

Result<std::unique_ptr<ReplaySource::Reader>> open_mcap_recording(io::McapReader reader,
                                                                  const std::filesystem::path& path) {
  if (!is_own_recording(reader))
    return fail(Errc::kInvalidArgument, path.string() + " is no recording of a robot: expected the topics " +
                                            std::string(io::kLidarPointsTopic) + " or " +
                                            std::string(io::kCameraImageTopic) + ", found " +
                                            list_topics(reader) + "; a recording of ROS needs --rig FILE");
  const auto attachment = reader.attachment(io::kRigAttachment);
  if (!attachment)
    return fail(Errc::kInvalidArgument, path.string() +
                                            " has no readable attachment rig.toml, which says what the "
                                            "robot's sensors are (" +
                                            attachment.error().context +
                                            "); a recording of edgesplat-robot --record holds it");
  const std::string_view text(reinterpret_cast<const char*>(attachment->content.data()),
                              attachment->content.size());
  EDGESPLAT_TRY(sensor::Rig rig, sensor::parse_rig(text, path.string() + ":rig.toml"));
  io::McapSelection selection;
  for (const std::string_view topic : {io::kLidarImuTopic, io::kCameraMetaTopic, io::kCameraImageTopic})
    selection.topics.emplace_back(topic);
  std::vector<RecordedLidar> lidars;
  for (std::size_t unit = 0; unit < rig.lidar_count(); ++unit) {
    std::string topic = io::topic_of_lidar(io::kLidarPointsTopic, unit);
    selection.topics.push_back(topic);
    const livox::LivoxSource source(protocol_of(reader, topic), {}, static_cast<std::uint8_t>(unit));
    lidars.push_back({std::move(topic), source});
  }
  reader.select(std::move(selection));
  return std::unique_ptr<ReplaySource::Reader>(
      std::make_unique<McapRecording>(std::move(reader), std::move(rig), std::move(lidars)));
}

}  // namespace edgesplat::replay
