// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/recording_writer.hpp"

#include "common/io/recording_topics.hpp"

#include <algorithm>
#include <string>

namespace edgesplat::simulate {
namespace {

// True poses are taken in host time; their message's stamp is the same number.
SensorTime as_stamp(HostTime time) {
  return sensor_time_from_ns(to_ns(time));
}

}  // namespace

Result<RecordingWriter> RecordingWriter::create(const std::filesystem::path& path, std::size_t lidars) {
  EDGESPLAT_TRY(io::McapWriter file, io::McapWriter::create(path));
  RecordingWriter writer(std::move(file));
  EDGESPLAT_TRY_STATUS(writer.add_channels(lidars));
  return writer;
}

Status RecordingWriter::add_channels(std::size_t lidars) {
  struct Row {
    std::string name;
    const io::RosSchema& schema;
  };
  std::vector<Row> rows = {
      // in the order of Topic
      {std::string(io::kLidarPointsTopic), io::kRawDatagramSchema},
      {std::string(io::kLidarImuTopic), io::kRawDatagramSchema},
      {std::string(io::kCameraMetaTopic), io::kFrameMetaSchema},
      {std::string(io::kCameraImageTopic), io::kCompressedImageSchema},
      {std::string(io::kTruthBodyPoseTopic), io::kPoseStampedSchema},
      {std::string(io::kTruthCameraCleanTopic), io::kCompressedImageSchema},
      {std::string(io::kTruthCameraMaskTopic), io::kCompressedImageSchema},
      {std::string(io::kTruthCameraDepthTopic), io::kCompressedImageSchema},
  };
  for (std::size_t unit = 1; unit < lidars; ++unit)
    rows.push_back({io::topic_of_lidar(io::kLidarPointsTopic, unit), io::kRawDatagramSchema});
  for (const Row& row : rows) {
    EDGESPLAT_TRY(const auto schema,
                  file_.add_schema(row.schema.name, io::kRosSchemaEncoding, row.schema.text));
    EDGESPLAT_TRY(channels_.emplace_back(), file_.add_channel(row.name, schema));
  }
  sequences_.resize(rows.size());
  return {};
}

void RecordingWriter::add(std::size_t topic, SensorTime stamp, HostTime arrival,
                          std::vector<std::byte> payload) {
  pending_.push_back({topic, stamp, arrival, std::move(payload)});
}

void RecordingWriter::add_points(std::size_t unit, SensorTime stamp, HostTime arrival,
                                 std::vector<std::byte> datagram) {
  add(unit == 0 ? std::size_t{kPoints} : kMorePoints + unit - 1, stamp, arrival,
      io::encode(io::RawDatagram{datagram}));
}

void RecordingWriter::add_imu(SensorTime stamp, HostTime arrival, std::vector<std::byte> datagram) {
  add(kImu, stamp, arrival, io::encode(io::RawDatagram{datagram}));
}

void RecordingWriter::add_pose(HostTime time, const geometry::RigidTransform& world_from_body) {
  add(kPose, as_stamp(time), time, io::encode(io::PoseStamped{time, "world", world_from_body}));
}

void RecordingWriter::add_picture(Topic topic, const RecordedFrame& frame, std::string_view format,
                                  const std::vector<std::byte>& encoded) {
  const io::CompressedImage message{frame.stamp, "camera", std::string(format), encoded};
  add(topic, frame.stamp, frame.arrival, io::encode(message));
}

void RecordingWriter::add_frame(const RecordedFrame& frame) {
  add(kMeta, frame.stamp, frame.arrival, io::encode(frame.meta));
  add_picture(kImage, frame, "jpeg", frame.image_jpeg);
  add_picture(kClean, frame, "png", frame.clean_png);
  add_picture(kMask, frame, "png", frame.mask_png);
  add_picture(kDepth, frame, "png", frame.depth_png);
}

Status RecordingWriter::write_until(HostTime time) {
  std::ranges::stable_sort(pending_, {}, &Pending::arrival);
  std::size_t written = 0;
  for (; written < pending_.size() && pending_[written].arrival < time; ++written) {
    const Pending& next = pending_[written];
    EDGESPLAT_TRY_STATUS(
        file_.write(channels_[next.topic], sequences_[next.topic]++, next.arrival, next.stamp, next.payload));
  }
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(written));
  return {};
}

Status RecordingWriter::attach(std::string_view name, std::string_view text) {
  return file_.add_attachment(name, "application/toml",
                              std::as_bytes(std::span<const char>(text.data(), text.size())));
}

Status RecordingWriter::close(const std::map<std::string, std::string>& metadata) {
  EDGESPLAT_TRY_STATUS(write_until(HostTime::max()));
  EDGESPLAT_TRY_STATUS(file_.add_metadata("simulation", metadata));
  return file_.close();
}

}  // namespace edgesplat::simulate
