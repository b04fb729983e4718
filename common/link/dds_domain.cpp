// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/dds_domain.hpp"

#include "dds/dds.h"

#include <net/if.h>

namespace edgesplat::link {

Result<std::shared_ptr<DdsDomain>> DdsDomain::open(const LinkConfig& config) {
  if (::if_nametoindex(config.interface.c_str()) == 0) {
    return fail(Errc::kInvalidConfig,
                "network interface \"" + config.interface +
                    "\" does not exist: set link.interface (or --interface) to one that "
                    "`ip link` lists");
  }
  const auto domain = static_cast<dds_domainid_t>(config.domain);
  const dds_entity_t handle = dds_create_domain(domain, cyclone_xml(config).c_str());
  if (handle == DDS_RETCODE_PRECONDITION_NOT_MET) {
    return fail(Errc::kUnavailable, "DDS domain " + std::to_string(config.domain) +
                                        " is already open in this process: share its DdsDomain");
  }
  if (handle < 0) {
    return fail(Errc::kInvalidConfig, "cannot open DDS domain " + std::to_string(config.domain) +
                                          " on interface \"" + config.interface + "\" (" +
                                          dds_strretcode(handle) +
                                          "): is the interface up, with an address?");
  }
  return std::shared_ptr<DdsDomain>(new DdsDomain(config, handle));
}

DdsDomain::~DdsDomain() {
  (void)dds_delete(handle_);
}

}  // namespace edgesplat::link
