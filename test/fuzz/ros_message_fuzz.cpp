// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/base/check.hpp"
#include "common/io/ros_sensor_messages.hpp"
#include "robot/drivers/replay/bag_pictures.hpp"
#include "robot/drivers/replay/bag_points.hpp"

#include <cstddef>
#include <cstdint>
#include <variant>

namespace {

using namespace edgesplat;

void check(const Result<std::optional<sensor::Measurement>>& converted) {
  if (!converted || !*converted) return;
  const auto* packet = std::get_if<sensor::LidarPacket>(&**converted);
  if (packet == nullptr) return;
  std::int32_t last_ns = 0;
  for (const sensor::LidarPoint& point : packet->points) {
    EDGESPLAT_CHECK(point.p_in_lidar_m.allFinite(), "points must be finite");
    EDGESPLAT_CHECK(point.offset_ns >= last_ns, "points must be in firing order");
    last_ns = point.offset_ns;
  }
}

}  // namespace

/// The first byte chooses encoding and message, the rest is the message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* first, std::size_t size) {
  if (size == 0) return 0;
  const auto bytes = std::as_bytes(std::span(first, size));
  const auto choice = static_cast<unsigned>(bytes.front());
  const auto encoding = (choice & 1U) == 0 ? io::RosEncoding::kRos1 : io::RosEncoding::kCdr;
  const auto payload = bytes.subspan(1);
  replay::BagPoints points{replay::BagSettings{}};
  switch ((choice >> 1U) % 5U) {
    case 0:
      (void)io::decode_ros_imu(encoding, payload);
      break;
    case 1:
      if (const auto image = io::decode_ros_image(encoding, payload)) (void)replay::picture_of(*image);
      break;
    case 2:
      if (const auto image = io::decode_ros_compressed_image(encoding, payload))
        (void)replay::picture_of(*image);
      break;
    case 3:
      if (const auto cloud = io::decode_ros_point_cloud(encoding, payload))
        check(points.convert(*cloud, HostTime{}));
      break;
    default:
      if (const auto message = io::decode_livox_custom(encoding, payload))
        check(points.convert(*message, replay::LivoxTags::kSdk1, HostTime{}));
  }
  return 0;
}
