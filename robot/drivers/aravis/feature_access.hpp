// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::aravis {

/// The named features (GenICam) of one camera, so that what is set in which order can be tried without one.
/// Errors: kNotFound for a feature that the camera has not, kUnavailable where it refuses or does not answer.
class FeatureAccess {
 public:
  virtual ~FeatureAccess() = default;
  [[nodiscard]] virtual bool has(std::string_view name) const = 0;
  /// The entries of an enumeration, empty where there is none.
  [[nodiscard]] virtual std::vector<std::string> choices(std::string_view name) const = 0;

  [[nodiscard]] virtual Status set(std::string_view name, bool value) = 0;
  [[nodiscard]] virtual Status set(std::string_view name, std::int64_t value) = 0;
  [[nodiscard]] virtual Status set(std::string_view name, double value) = 0;
  [[nodiscard]] virtual Status choose(std::string_view name, std::string_view entry) = 0;
  [[nodiscard]] virtual Status execute(std::string_view name) = 0;

  [[nodiscard]] virtual Result<std::int64_t> integer(std::string_view name) = 0;
  [[nodiscard]] virtual Result<double> number(std::string_view name) = 0;
  [[nodiscard]] virtual Result<std::string> chosen(std::string_view name) = 0;
};

}  // namespace edgesplat::aravis
