// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/serial_imu/serial_source.hpp"

namespace edgesplat::serial_imu {
namespace {

constexpr float kMostRate_radps = 100.0F;   // 5700 degrees a second
constexpr float kMostForce_mps2 = 1000.0F;  // 100 g
constexpr int kBackwardsForRestart = 10;

bool is_sane(const Eigen::Vector3f& v, float most) {
  return v.allFinite() && v.cwiseAbs().maxCoeff() <= most;
}

}  // namespace

std::optional<sensor::Measurement> SerialSource::on_frame(const InertialFrame& frame, HostTime arrival) {
  if (!is_sane(frame.gyro_radps, kMostRate_radps) || !is_sane(frame.accel_mps2, kMostForce_mps2)) {
    ++counters_.bad_value;
    return std::nullopt;
  }
  if (newest_sequence_ && frame.stamp <= newest_stamp_) {
    if (++backwards_ < kBackwardsForRestart) {
      ++counters_.bad_stamp;
      return std::nullopt;
    }
    ++counters_.restarts;
    newest_sequence_.reset();
  }
  backwards_ = 0;
  if (newest_sequence_) counters_.lost += static_cast<std::uint16_t>(frame.sequence - *newest_sequence_ - 1);
  newest_sequence_ = frame.sequence;
  newest_stamp_ = frame.stamp;
  ++counters_.samples;
  sensor::ImuSample sample;
  sample.stamp = frame.stamp;
  sample.arrival = arrival;
  sample.stamp_source = sensor::StampSource::kFreeRunning;
  sample.gyro_radps = frame.gyro_radps.cast<double>();
  sample.accel_mps2 = frame.accel_mps2.cast<double>();
  return sample;
}

}  // namespace edgesplat::serial_imu
