// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/accuracy/evaluation.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace edgesplat::accuracy {

/// Keys carry their units; "kitti" is null for a path under 100 m.
[[nodiscard]] nlohmann::json to_json(const Evaluation& evaluation);
/// A table for people.
[[nodiscard]] std::string to_text(const Evaluation& evaluation);

}  // namespace edgesplat::accuracy
