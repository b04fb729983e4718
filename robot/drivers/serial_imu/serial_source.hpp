// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "robot/drivers/serial_imu/serial_protocol.hpp"

#include <cstdint>
#include <optional>

namespace edgesplat::serial_imu {

struct SourceCounters {
  std::uint64_t samples = 0;    ///< handed on
  std::uint64_t lost = 0;       ///< holes in the sequence
  std::uint64_t bad_value = 0;  ///< not finite, or more than any such sensor measures: not used
  std::uint64_t bad_stamp = 0;  ///< not newer than the one before: not used
  std::uint64_t restarts = 0;   ///< the sensor's clock began anew
};

/// Inertial frames to ImuSamples: watches sequence, stamps and values. Thread-bound, no allocation.
class SerialSource {
 public:
  [[nodiscard]] std::optional<sensor::Measurement> on_frame(const InertialFrame& frame, HostTime arrival);
  [[nodiscard]] const SourceCounters& counters() const { return counters_; }

 private:
  std::optional<std::uint16_t> newest_sequence_;
  SensorTime newest_stamp_{};
  int backwards_ = 0;  ///< frames in a row that are older than the newest
  SourceCounters counters_;
};

}  // namespace edgesplat::serial_imu
