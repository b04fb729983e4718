// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/io/ros_messages.hpp"

#include "common/io/cdr.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgesplat::io {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

/// builtin_interfaces/Time: floor of the seconds, rest in [0, 1e9) ns.
void write_time(CdrWriter& writer, std::int64_t time_ns) {
  const std::int64_t rest_ns = ((time_ns % kNsPerSecond) + kNsPerSecond) % kNsPerSecond;
  const std::int64_t seconds = (time_ns - rest_ns) / kNsPerSecond;
  using Limits = std::numeric_limits<std::int32_t>;
  writer.write(static_cast<std::int32_t>(std::clamp<std::int64_t>(seconds, Limits::min(), Limits::max())));
  writer.write(static_cast<std::uint32_t>(rest_ns));
}

std::int64_t read_time_ns(CdrReader& reader) {
  const auto seconds = reader.read<std::int32_t>();
  const auto rest_ns = reader.read<std::uint32_t>();
  return seconds * kNsPerSecond + rest_ns;
}

tl::unexpected<Error> does_not_fit(const RosSchema& schema, std::size_t payload_bytes) {
  return fail(Errc::kCorrupt, "a payload of " + std::to_string(payload_bytes) + " bytes is no " +
                                  std::string(schema.name) + " in little-endian CDR");
}

}  // namespace

std::vector<std::byte> encode(const RawDatagram& message) {
  CdrWriter writer(message.datagram.size() + 8);
  writer.write_byte_sequence(message.datagram);
  return writer.take();
}

std::vector<std::byte> encode(const FrameMeta& message) {
  CdrWriter writer(24);
  write_time(writer, to_ns(message.stamp));
  writer.write(message.sequence);
  writer.write(message.exposure_s);
  writer.write(message.gain_db);
  writer.write(static_cast<std::uint8_t>(message.stamp_source));
  return writer.take();
}

std::vector<std::byte> encode(const CompressedImage& message) {
  CdrWriter writer(message.encoded.size() + message.frame_id.size() + message.format.size() + 32);
  write_time(writer, to_ns(message.stamp));
  writer.write_string(message.frame_id);
  writer.write_string(message.format);
  writer.write_byte_sequence(message.encoded);
  return writer.take();
}

std::vector<std::byte> encode(const PoseStamped& message) {
  CdrWriter writer(80 + message.frame_id.size());
  write_time(writer, to_ns(message.stamp));
  writer.write_string(message.frame_id);
  const auto& pose = message.frame_from_body;
  for (const double value : {pose.translation_m.x(), pose.translation_m.y(), pose.translation_m.z(),
                             pose.rotation.x(), pose.rotation.y(), pose.rotation.z(), pose.rotation.w()}) {
    writer.write(value);
  }
  return writer.take();
}

Result<RawDatagram> decode_raw_datagram(std::span<const std::byte> payload) {
  CdrReader reader(payload);
  const RawDatagram message{reader.read_byte_sequence()};
  if (!reader.ok()) return does_not_fit(kRawDatagramSchema, payload.size());
  return message;
}

Result<FrameMeta> decode_frame_meta(std::span<const std::byte> payload) {
  CdrReader reader(payload);
  FrameMeta message;
  message.stamp = sensor_time_from_ns(read_time_ns(reader));
  message.sequence = reader.read<std::uint32_t>();
  message.exposure_s = reader.read<float>();
  message.gain_db = reader.read<float>();
  const auto source = reader.read<std::uint8_t>();
  const bool plausible = std::isfinite(message.exposure_s) && message.exposure_s >= 0.0F &&
                         std::isfinite(message.gain_db) &&
                         source <= static_cast<std::uint8_t>(sensor::StampSource::kGps);
  if (!reader.ok() || !plausible) return does_not_fit(kFrameMetaSchema, payload.size());
  message.stamp_source = static_cast<sensor::StampSource>(source);
  return message;
}

Result<CompressedImage> decode_compressed_image(std::span<const std::byte> payload) {
  CdrReader reader(payload);
  CompressedImage message;
  message.stamp = sensor_time_from_ns(read_time_ns(reader));
  message.frame_id = reader.read_string();
  message.format = reader.read_string();
  message.encoded = reader.read_byte_sequence();
  if (!reader.ok()) return does_not_fit(kCompressedImageSchema, payload.size());
  return message;
}

Result<PoseStamped> decode_pose_stamped(std::span<const std::byte> payload) {
  CdrReader reader(payload);
  PoseStamped message;
  message.stamp = host_time_from_ns(read_time_ns(reader));
  message.frame_id = reader.read_string();
  auto& pose = message.frame_from_body;
  for (int i = 0; i < 3; ++i) pose.translation_m[i] = reader.read<double>();
  for (int i = 0; i < 4; ++i) pose.rotation.coeffs()[i] = reader.read<double>();  // x y z w
  const double norm = pose.rotation.norm();
  // Written so that a NaN fails too.
  if (!reader.ok() || !pose.is_finite() || !(std::abs(norm - 1.0) < 1e-3)) {
    return does_not_fit(kPoseStampedSchema, payload.size());
  }
  return message;
}

}  // namespace edgesplat::io
