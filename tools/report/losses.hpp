// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace edgesplat::report {

/// A counter of something lost, late, refused or dropped that is not 0.
struct Loss {
  std::string program;  ///< "robot" or "server"
  std::string name;
  nlohmann::json count;  ///< a number, as written
};

struct Losses {
  std::vector<Loss> losses;
  std::size_t zero = 0;  ///< such counters that are 0
  [[nodiscard]] bool counted() const { return zero > 0 || !losses.empty(); }
};

/// Of both programs' metrics.json; null where one is absent.
[[nodiscard]] Losses find_losses(const nlohmann::json& robot_metrics, const nlohmann::json& server_metrics);

}  // namespace edgesplat::report
