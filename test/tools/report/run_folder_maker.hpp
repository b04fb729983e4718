// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"

#include <filesystem>

namespace edgesplat::report {

/// Writes a whole run folder as the robot and server leave it: 20 s along a winding path with known errors
/// (constant 0.03 m in z, growing 0.01 m/s in x), pictures, points of a corridor, metrics.
[[nodiscard]] Status make_run_folder(const std::filesystem::path& folder);

}  // namespace edgesplat::report
