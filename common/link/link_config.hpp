// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"
#include "common/link/impairment.hpp"
#include "common/link/send_queue.hpp"

#include <string>

namespace edgesplat::link {

struct LinkConfig {
  std::string interface = "lo";      ///< name of the network interface (`ip link`); never chosen by itself
  std::string peers = "127.0.0.1";   ///< addresses of the other ends, separated by commas
  int domain = 0;                    ///< DDS domain, 0..230; both ends the same
  bool multicast_discovery = false;  ///< find peers by multicast as well (not on lo)
  std::size_t queue_messages = 64;   ///< waiting to be sent, per lane, 1..4096
  std::size_t queue_megabytes = 64;  ///< the same in MiB, 1..1024
  std::size_t inbox_messages = 32;   ///< received and not yet taken, 1..4096
  ImpairmentConfig impair;           ///< for demonstrations and tests
};

void describe(config::ConfigReader& reader, LinkConfig& config);
[[nodiscard]] SendLimits send_limits(const LinkConfig& config);

/// Cyclone's own configuration for this link as XML: the named interface only, explicit peers, messages of
/// 1400 bytes, a lease of 2 s.
[[nodiscard]] std::string cyclone_xml(const LinkConfig& config);

}  // namespace edgesplat::link
