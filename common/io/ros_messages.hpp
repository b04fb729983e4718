// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/sensor/measurement.hpp"
#include "common/time/time.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::io {

/// Name and text of a ROS 2 message type as MCAP wants it: encoding "ros2msg", the types it uses appended
/// behind lines of '='. Foxglove reads recordings by these.
struct RosSchema {
  std::string_view name;
  std::string_view text;
};
inline constexpr std::string_view kRosSchemaEncoding = "ros2msg";
extern const RosSchema kRawDatagramSchema;      ///< edgesplat_msgs/msg/RawDatagram
extern const RosSchema kFrameMetaSchema;        ///< edgesplat_msgs/msg/FrameMeta
extern const RosSchema kCompressedImageSchema;  ///< sensor_msgs/msg/CompressedImage
extern const RosSchema kPoseStampedSchema;      ///< geometry_msgs/msg/PoseStamped

/// Bytes of these messages are borrowed: when decoding from the payload, when encoding from the caller.
/// builtin_interfaces/Time holds 32-bit seconds: stamps outside +-68 years are clamped (publish_time is
/// exact).
struct RawDatagram {
  std::span<const std::byte> datagram;
};
struct FrameMeta {
  SensorTime stamp{};
  std::uint32_t sequence = 0;
  float exposure_s = 0.0F;
  float gain_db = 0.0F;
  sensor::StampSource stamp_source = sensor::StampSource::kFreeRunning;
};
struct CompressedImage {
  SensorTime stamp{};
  std::string frame_id;
  std::string format;  ///< "jpeg" or "png"
  std::span<const std::byte> encoded;
};
struct PoseStamped {
  HostTime stamp{};
  std::string frame_id;  ///< the frame the pose is given in
  geometry::RigidTransform frame_from_body;
};

[[nodiscard]] std::vector<std::byte> encode(const RawDatagram& message);
[[nodiscard]] std::vector<std::byte> encode(const FrameMeta& message);
[[nodiscard]] std::vector<std::byte> encode(const CompressedImage& message);
[[nodiscard]] std::vector<std::byte> encode(const PoseStamped& message);

/// kCorrupt where the payload is too short, not little-endian CDR, or holds an impossible value.
[[nodiscard]] Result<RawDatagram> decode_raw_datagram(std::span<const std::byte> payload);
[[nodiscard]] Result<FrameMeta> decode_frame_meta(std::span<const std::byte> payload);
[[nodiscard]] Result<CompressedImage> decode_compressed_image(std::span<const std::byte> payload);
[[nodiscard]] Result<PoseStamped> decode_pose_stamped(std::span<const std::byte> payload);

}  // namespace edgesplat::io
