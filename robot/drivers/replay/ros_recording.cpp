// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/replay/ros_recording.hpp"

#include "common/io/ros_sensor_messages.hpp"
#include "robot/drivers/livox/point_record.hpp"
#include "robot/drivers/replay/bag_pictures.hpp"
#include "robot/drivers/replay/bag_points.hpp"
#include "robot/drivers/replay/bag_topics.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace edgesplat::replay {
namespace {

constexpr std::int64_t kLatest_ns = std::int64_t{1} << 62U;  // sums and differences of times stay in range

class RosRecording final : public ReplaySource::Reader {
 public:
  RosRecording(std::unique_ptr<io::BagSource> bag, BagRig rig, const BagTopics& topics)
      : bag_(std::move(bag)), rig_(std::move(rig)), topics_(topics), points_(rig_.replay) {
    if (!topics_.image) rig_.rig.camera.reset();
    if (topics_.imu) accel_to_mps2_ = find_accel_unit(*topics_.imu);
    std::vector<std::size_t> chosen;
    for (const auto& topic : {topics_.lidar, topics_.imu, topics_.image})
      if (topic) chosen.push_back(*topic);
    bag_->select(std::move(chosen));
  }

  [[nodiscard]] const sensor::Rig& rig() const override { return rig_.rig; }
  [[nodiscard]] nanoseconds duration() const override { return bag_->end() - bag_->begin(); }
  [[nodiscard]] HostTime begin() const override { return bag_->begin(); }
  [[nodiscard]] ReplayReport report() const override;
  [[nodiscard]] Result<std::optional<sensor::Measurement>> next() override;

 private:
  using Converted = Result<std::optional<sensor::Measurement>>;
  [[nodiscard]] double find_accel_unit(std::size_t topic);
  [[nodiscard]] Converted convert(const io::BagMessage& message);
  [[nodiscard]] Converted convert_points(const io::BagTopic& topic, const io::BagMessage& message);
  [[nodiscard]] Converted convert_imu(io::RosEncoding encoding, const io::BagMessage& message) const;
  [[nodiscard]] Converted convert_picture(const io::BagTopic& topic, const io::BagMessage& message);
  [[nodiscard]] sensor::StampSource stamp_source() const {
    return rig_.replay.clock == StampClock::kHeader ? sensor::StampSource::kPtp
                                                    : sensor::StampSource::kFreeRunning;
  }

  std::unique_ptr<io::BagSource> bag_;
  BagRig rig_;
  BagTopics topics_;
  BagPoints points_;
  double accel_to_mps2_ = 1.0;
  std::uint32_t frame_number_ = 0;
  std::uint64_t measurements_ = 0;
  std::uint64_t messages_refused_ = 0;
  std::string first_message_refusal_;
  std::uint64_t frames_refused_ = 0;
  std::string first_frame_refusal_;
};

/// A robot that begins to move feels about 1 g: the median of the first samples tells the unit.
double RosRecording::find_accel_unit(std::size_t topic) {
  if (rig_.replay.imu_accel_unit != AccelUnit::kAuto)
    return rig_.replay.imu_accel_unit == AccelUnit::kG ? livox::kStandardGravity_mps2 : 1.0;
  constexpr std::size_t kSamples = 100;
  constexpr double kBetween = 4.0;  // of 1 and 9.8
  bag_->select({topic});
  std::vector<double> lengths;
  while (lengths.size() < kSamples) {
    const auto message = bag_->next();
    if (!message) break;
    const auto imu = io::decode_ros_imu(bag_->topics()[topic].encoding, message->payload);
    if (imu) lengths.push_back(imu->linear_acceleration.norm());
  }
  if (lengths.empty()) return 1.0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle < kBetween ? livox::kStandardGravity_mps2 : 1.0;
}

Result<std::optional<sensor::Measurement>> RosRecording::next() {
  while (const auto message = bag_->next()) {
    const std::int64_t time_ns = to_ns(message->time);
    auto measurement = time_ns >= 0 && time_ns < kLatest_ns
                           ? convert(*message)
                           : Converted(fail(Errc::kCorrupt, "a message has an impossible time"));
    if (measurement) {
      if (!*measurement) continue;
      ++measurements_;
      return measurement;
    }
    const bool is_frame = message->topic == topics_.image;
    ++(is_frame ? frames_refused_ : messages_refused_);
    std::string& first = is_frame ? first_frame_refusal_ : first_message_refusal_;
    if (first.empty()) first = std::move(measurement.error().context);
  }
  return std::nullopt;
}

RosRecording::Converted RosRecording::convert(const io::BagMessage& message) {
  const io::BagTopic& topic = bag_->topics()[message.topic];
  if (message.topic == topics_.lidar) return convert_points(topic, message);
  if (message.topic == topics_.imu) return convert_imu(topic.encoding, message);
  return convert_picture(topic, message);
}

RosRecording::Converted RosRecording::convert_points(const io::BagTopic& topic,
                                                     const io::BagMessage& message) {
  if (!is_livox_custom(topic)) {
    EDGESPLAT_TRY(const io::RosPointCloud cloud, io::decode_ros_point_cloud(topic.encoding, message.payload));
    return points_.convert(cloud, message.time);
  }
  EDGESPLAT_TRY(const io::LivoxCustomMessage custom,
                io::decode_livox_custom(topic.encoding, message.payload));
  const bool is_sdk1 = topic.type == "livox_ros_driver/CustomMsg";
  return points_.convert(custom, is_sdk1 ? LivoxTags::kSdk1 : LivoxTags::kSdk2, message.time);
}

RosRecording::Converted RosRecording::convert_imu(io::RosEncoding encoding,
                                                  const io::BagMessage& message) const {
  EDGESPLAT_TRY(const io::RosImu imu, io::decode_ros_imu(encoding, message.payload));
  sensor::ImuSample sample;
  sample.stamp = imu.header.stamp + from_seconds(rig_.replay.imu_stamp_offset_s);
  sample.arrival = message.time;
  sample.stamp_source = stamp_source();
  sample.gyro_radps = imu.angular_velocity;
  sample.accel_mps2 = imu.linear_acceleration * accel_to_mps2_;
  return sample;
}

RosRecording::Converted RosRecording::convert_picture(const io::BagTopic& topic,
                                                      const io::BagMessage& message) {
  sensor::CameraFrame frame;
  sensor::ImageRgb8 picture;
  if (topic.type == "sensor_msgs/Image") {
    EDGESPLAT_TRY(const io::RosImage image, io::decode_ros_image(topic.encoding, message.payload));
    EDGESPLAT_TRY(picture, picture_of(image));
    frame.stamp = image.header.stamp;
  } else {
    EDGESPLAT_TRY(const io::RosCompressedImage image,
                  io::decode_ros_compressed_image(topic.encoding, message.payload));
    EDGESPLAT_TRY(picture, picture_of(image));
    frame.stamp = image.header.stamp;
  }
  const geometry::CameraModel& camera = rig_.rig.camera->model;
  if (picture.width_px != camera.width_px || picture.height_px != camera.height_px) {
    return fail(Errc::kCorrupt, "a picture is " + std::to_string(picture.width_px) + "x" +
                                    std::to_string(picture.height_px) + " pixels, the rig's camera " +
                                    std::to_string(camera.width_px) + "x" + std::to_string(camera.height_px));
  }
  frame.arrival = message.time;
  frame.stamp_source = stamp_source();
  frame.sequence = frame_number_++;
  frame.image = std::make_shared<const sensor::ImageRgb8>(std::move(picture));
  return frame;
}

ReplayReport RosRecording::report() const {
  const io::BagReport file = bag_->report();
  ReplayReport report;
  report.measurements = measurements_;
  report.bytes_skipped = file.bytes_skipped;
  report.packets_refused = messages_refused_;
  report.frames_refused = frames_refused_;
  report.points_dropped = points_.dropped();
  report.why = file.why;
  const auto add = [&report](std::uint64_t count, const char* what, const std::string& first) {
    if (count == 0) return;
    report.why += (report.why.empty() ? "" : "; ") + std::to_string(count) + what + first;
  };
  add(messages_refused_, " messages refused: ", first_message_refusal_);
  add(frames_refused_, " pictures refused: ", first_frame_refusal_);
  report.complete = report.why.empty();
  return report;
}

}  // namespace

Result<std::unique_ptr<ReplaySource::Reader>> open_ros_recording(std::unique_ptr<io::BagSource> bag,
                                                                 BagRig rig) {
  EDGESPLAT_TRY(const BagTopics topics, choose_topics(bag->topics(), rig));
  return std::make_unique<RosRecording>(std::move(bag), std::move(rig), topics);
}

}  // namespace edgesplat::replay
