// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/image.hpp"
#include "common/time/time.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace edgesplat::sensor {

/// What disciplines the clock that stamped a measurement.
enum class StampSource : std::uint8_t { kFreeRunning, kPtp, kGps };

/// One inertial sample in the IMU frame (= body frame).
struct ImuSample {
  SensorTime stamp{};
  HostTime arrival{};
  StampSource stamp_source = StampSource::kFreeRunning;
  Eigen::Vector3d gyro_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mps2 = Eigen::Vector3d::Zero();  ///< specific force: +9.81 on z at rest
};

/// One LiDAR return.
struct LidarPoint {
  Eigen::Vector3f p_in_lidar_m = Eigen::Vector3f::Zero();
  float reflectivity = 0.0F;     ///< 0..1
  std::int32_t offset_ns = 0;    ///< time of the ray after the packet's or scan's stamp
  std::uint8_t line = 0;         ///< laser line or ring
  std::uint8_t noise_class = 0;  ///< 0 good, 1 medium confidence; low confidence never leaves the driver
};

/// The points of one packet, in firing order; returns only (no zero points).
struct LidarPacket {
  SensorTime stamp{};  ///< of the first ray
  HostTime arrival{};
  StampSource stamp_source = StampSource::kFreeRunning;
  nanoseconds span{};     ///< first ray to last ray
  std::uint8_t unit = 0;  ///< which of the rig's LiDARs
  std::vector<LidarPoint> points;
};

/// A whole revolution from a recording that has no packets. `has_point_times` false: every offset_ns is 0 and
/// the scan is taken as if measured at `stamp`.
struct LidarScan {
  SensorTime stamp{};
  HostTime arrival{};
  bool has_point_times = false;
  std::vector<LidarPoint> points;
};

/// One camera image. `stamp` is the middle of the exposure.
struct CameraFrame {
  SensorTime stamp{};
  HostTime arrival{};
  StampSource stamp_source = StampSource::kFreeRunning;
  std::uint32_t sequence = 0;
  float exposure_s = 0.0F;  ///< 0 = unknown
  float gain_db = 0.0F;
  std::shared_ptr<const ImageRgb8> image;
};

/// What every source hands on, live or replayed.
using Measurement = std::variant<ImuSample, LidarPacket, LidarScan, CameraFrame>;

/// When it reached this machine, whatever it is.
[[nodiscard]] inline HostTime arrival_of(const Measurement& measurement) {
  return std::visit([](const auto& m) { return m.arrival; }, measurement);
}

}  // namespace edgesplat::sensor
