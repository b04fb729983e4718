// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::sync {

/// One port of the PTP clock of this machine.
struct PtpPort {
  std::string identity;  ///< "001122.fffe.334455-1"
  std::string state;     ///< MASTER, SLAVE, PASSIVE, LISTENING, UNCALIBRATED, FAULTY, ...
};

/// What ptp4l (linuxptp) says about PTP on this machine.
struct PtpReport {
  std::vector<PtpPort> ports;
  std::optional<double> offset_from_master_ns;  ///< CURRENT_DATA_SET; 0 on the grandmaster itself
  std::optional<double> mean_path_delay_ns;
  std::optional<std::int64_t> steps_removed;  ///< 0: this machine is the grandmaster
  std::optional<bool> grandmaster_present;    ///< TIME_STATUS_NP; false on the grandmaster itself
  std::string grandmaster;                    ///< its identity

  [[nodiscard]] bool has_port_in(std::string_view state) const;
};

/// The text of `pmc -u -b 0 'GET PORT_DATA_SET' 'GET CURRENT_DATA_SET' 'GET TIME_STATUS_NP'`: answers of any
/// order, fields that are not known left out. kUnavailable where it has no answer of a port: ptp4l does not
/// run.
[[nodiscard]] Result<PtpReport> parse_pmc(std::string_view text);

}  // namespace edgesplat::sync
