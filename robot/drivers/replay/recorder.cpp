// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/recorder.hpp"

#include "common/base/bytes.hpp"
#include "common/base/check.hpp"
#include "common/io/recording_topics.hpp"
#include "common/io/ros_messages.hpp"
#include "robot/drivers/livox/sdk1_packet.hpp"

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

namespace edgesplat::replay {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

/// The stamp of a Livox data packet; 0 where the datagram has none.
SensorTime stamp_of(std::span<const std::byte> datagram, livox::Protocol protocol) {
  if (protocol == livox::Protocol::kSdk1) {
    const auto packet = livox::decode_sdk1_packet(datagram);
    return packet ? packet->stamp : SensorTime{};
  }
  constexpr std::size_t kStampAt = 28;
  ByteReader reader(datagram);
  reader.skip(kStampAt);
  return sensor_time_from_ns(reader.read<std::int64_t>());
}

io::FrameMeta meta_of(const frame_socket::FrameHeader& header) {
  return {header.stamp, header.sequence, header.exposure_s, header.gain_db, header.stamp_source};
}

}  // namespace

Result<std::unique_ptr<Recorder>> Recorder::create(const std::filesystem::path& path,
                                                   std::string_view rig_toml, std::string_view robot_toml,
                                                   const RecorderConfig& config) {
  io::McapWriterOptions options;
  options.chunk_span = config.chunk_span;
  EDGESPLAT_TRY(io::McapWriter writer, io::McapWriter::create(path, options));
  std::unique_ptr<Recorder> recorder(new Recorder(std::move(writer), path, config));
  EDGESPLAT_TRY_STATUS(
      recorder->writer_.add_attachment(io::kRigAttachment, "application/toml", bytes_of(rig_toml)));
  EDGESPLAT_TRY_STATUS(
      recorder->writer_.add_attachment(io::kRobotConfigAttachment, "application/toml", bytes_of(robot_toml)));
  EDGESPLAT_TRY_STATUS(recorder->add_channels());
  return recorder;
}

Recorder::Recorder(io::McapWriter writer, std::filesystem::path path, const RecorderConfig& config)
    : config_(config),
      path_(std::move(path)),
      writer_(std::move(writer)),
      queue_({config.queue_items, config.queue_bytes}, thread::Overflow::kDropNewest) {}

Status Recorder::add_channels() {
  EDGESPLAT_TRY_STATUS(add_channel(std::string(io::kCameraMetaTopic), io::kFrameMetaSchema, {}));
  EDGESPLAT_TRY_STATUS(add_channel(std::string(io::kCameraImageTopic), io::kCompressedImageSchema, {}));
  for (std::size_t unit = 0; unit < config_.lidar_protocols.size(); ++unit) {
    const bool is_sdk1 = config_.lidar_protocols[unit] == livox::Protocol::kSdk1;
    const std::string protocol(is_sdk1 ? io::kLivoxSdk1 : io::kLivoxSdk2);
    for (const std::string_view topic : {io::kLidarPointsTopic, io::kLidarImuTopic, io::kLidarControlTopic})
      EDGESPLAT_TRY_STATUS(add_channel(io::topic_of_lidar(topic, unit), io::kRawDatagramSchema,
                                       {{std::string(io::kProtocolKey), protocol}}));
  }
  return {};
}

Status Recorder::add_channel(const std::string& name, const io::RosSchema& schema,
                             std::map<std::string, std::string> metadata) {
  EDGESPLAT_TRY(const io::McapSchemaId id,
                writer_.add_schema(schema.name, io::kRosSchemaEncoding, schema.text));
  EDGESPLAT_TRY(channels_.emplace_back(), writer_.add_channel(name, id, "cdr", std::move(metadata)));
  sequences_.push_back(0);
  return {};
}

void Recorder::on_datagram(const livox::Datagram& datagram, std::size_t unit) {
  EDGESPLAT_CHECK(unit < config_.lidar_protocols.size(), "every LiDAR has topics");
  (void)queue_.push(
      QueuedDatagram{
          unit, datagram.channel, datagram.arrival, {datagram.bytes.begin(), datagram.bytes.end()}},
      datagram.bytes.size());  // a full queue counts by itself
}

void Recorder::on_frame(const frame_socket::EncodedFrame& frame, HostTime arrival, HostTime handed_on) {
  (void)queue_.push(QueuedFrame{arrival, std::max(arrival, handed_on), frame}, frame.payload.size());
}

Result<bool> Recorder::write_next(const std::stop_token& stop) {
  const auto item = queue_.pop_for(config_.chunk_span, stop);
  if (item) {
    EDGESPLAT_TRY_STATUS(write(*item));
    EDGESPLAT_TRY_STATUS(look_after_disk(newest_));
    return true;
  }
  // Nothing comes: what is there must not wait for something that does.
  if (std::exchange(has_unflushed_, false)) {
    EDGESPLAT_TRY_STATUS(writer_.flush());
  }
  return !stop.stop_requested() && !queue_.finished();
}

Status Recorder::look_after_disk(HostTime newest) {
  if (is_stopped_ || newest < next_look_) return {};
  const bool syncs = config_.sync_period > nanoseconds(0);
  next_look_ = newest + (syncs ? config_.sync_period : nanoseconds(std::chrono::seconds(1)));
  if (syncs) EDGESPLAT_TRY_STATUS(writer_.sync());
  std::error_code error;
  const auto space = std::filesystem::space(path_, error);
  if (error || space.available >= config_.min_free_bytes) return {};
  is_stopped_ = true;
  EDGESPLAT_TRY_STATUS(writer_.close());
  constexpr std::uintmax_t kMega = 1'000'000;
  return fail(Errc::kIo, "the recording " + path_.string() + " ended, whole: its disk has " +
                             std::to_string(space.available / kMega) +
                             " MB left, less than record.min_free_bytes (" +
                             std::to_string(config_.min_free_bytes / kMega) + " MB)");
}

Status Recorder::finish() {
  queue_.close();
  Status first;
  while (const auto item = queue_.try_pop()) {
    if (Status status = write(*item); !status && first) first = std::move(status);
  }
  Status closed = writer_.close();
  if (is_stopped_ && first && closed)
    return fail(Errc::kIo, "the recording " + path_.string() + " ended before the run for lack of room: " +
                               std::to_string(failed_.load()) + " messages are not in it");
  return first ? closed : first;
}

Status Recorder::write(const Item& item) {
  if (is_stopped_) {
    ++failed_;
    return {};
  }
  const std::uint64_t dropped_before =
      writer_.messages_dropped();  // after a full disk the writer only counts
  Status status = std::visit([this](const auto& one) { return write(one); }, item);
  ++(status && writer_.messages_dropped() == dropped_before ? written_ : failed_);
  return status;
}

Status Recorder::write(const QueuedDatagram& datagram) {
  const bool is_data =
      datagram.channel == livox::Channel::kPoints || datagram.channel == livox::Channel::kImu;
  const std::size_t of_lidar = !is_data ? 2U : (datagram.channel == livox::Channel::kImu ? 1U : 0U);
  const std::size_t topic = kFirstOfLidars + kOfLidar * datagram.unit + of_lidar;
  const SensorTime stamp =
      is_data ? stamp_of(datagram.bytes, config_.lidar_protocols[datagram.unit]) : SensorTime{};
  return write(topic, datagram.arrival, stamp, io::encode(io::RawDatagram{datagram.bytes}));
}

Status Recorder::write(const QueuedFrame& queued) {
  const frame_socket::FrameHeader& header = queued.frame.header;
  EDGESPLAT_TRY_STATUS(write(kMeta, queued.arrival, header.stamp, io::encode(meta_of(header))));
  io::CompressedImage image;
  image.stamp = header.stamp;
  image.frame_id = "camera";
  image.format = header.format == frame_socket::PictureFormat::kPng ? "png" : "jpeg";
  image.encoded = queued.frame.payload;
  return write(kImage, queued.handed_on, header.stamp, io::encode(image));
}

Status Recorder::write(std::size_t topic, HostTime arrival, SensorTime stamp,
                       std::span<const std::byte> payload) {
  newest_ = arrival;
  has_unflushed_ = true;
  return writer_.write(channels_.at(topic), sequences_.at(topic)++, arrival, stamp, payload);
}

RecorderCounters Recorder::counters() const {
  return {written_.load(), queue_.stats().dropped, failed_.load()};
}

}  // namespace edgesplat::replay
