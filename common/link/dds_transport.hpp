// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/dds_domain.hpp"
#include "common/link/transport.hpp"
#include "common/time/clock.hpp"

#include <cstdint>
#include <memory>

namespace edgesplat::link {

struct DdsTransportOptions {
  Role role = Role::kRobot;
  map::RobotId robot{1};      ///< this robot; a robot takes only what is meant for it. The server ignores it
  std::uint64_t session = 0;  ///< must differ after a restart; 0: taken from the system's random source
};

/// One end of the link over Cyclone DDS. Starts the link thread, which alone reads and writes; data and peers
/// wake it, nothing polls. Messages wait in the bounded queue until a peer is there. `clock` must outlive the
/// transport. Errors: kUnavailable with the reason where DDS refuses.
[[nodiscard]] Result<std::unique_ptr<Transport>> open_dds_transport(std::shared_ptr<DdsDomain> domain,
                                                                    const DdsTransportOptions& options,
                                                                    const Clock& clock);

}  // namespace edgesplat::link
