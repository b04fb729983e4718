// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/livox/livox_command.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace edgesplat::livox {

/// What a parameter list says of the state of a LiDAR; what it does not name is absent.
struct Sdk2Report {
  std::optional<std::string> serial_number;
  std::optional<std::uint8_t> firmware_type;  ///< 0: runs its loader only
  std::optional<std::uint8_t>
      work_state;  ///< 1 sampling, 2 idle, 4 error, 5 self-check, 6 motor start, 9 ready
  std::optional<std::uint8_t> work_mode;  ///< what was asked for
  std::optional<double> core_temperature_deg;
  std::optional<std::int64_t> time_offset_ns;  ///< its clock minus the master's
  std::optional<std::string> sync;             ///< none, ptp, gps
  std::optional<std::string> faults;           ///< codes that are not 0, separated by blanks
};
[[nodiscard]] Sdk2Report read_report(std::span<const KeyValue> values);

}  // namespace edgesplat::livox
