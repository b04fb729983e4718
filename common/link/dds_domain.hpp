// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/link/link_config.hpp"

#include <cstdint>
#include <memory>

namespace edgesplat::link {

/// This process's part in a DDS domain. Cyclone keeps one configuration per domain and process, so a process
/// makes one and hands it to its transports, which keep it alive. Thread-safe.
class DdsDomain {
 public:
  /// Errors: kInvalidConfig where the network interface does not exist or the configuration is refused;
  /// kUnavailable where this process has the domain open already.
  static Result<std::shared_ptr<DdsDomain>> open(const LinkConfig& config);
  ~DdsDomain();
  DdsDomain(const DdsDomain&) = delete;
  DdsDomain& operator=(const DdsDomain&) = delete;

  [[nodiscard]] const LinkConfig& config() const { return config_; }

 private:
  DdsDomain(LinkConfig config, std::int32_t handle) : config_(std::move(config)), handle_(handle) {}
  LinkConfig config_;
  std::int32_t handle_;  ///< dds_entity_t
};

}  // namespace edgesplat::link
