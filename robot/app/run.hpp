// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "robot/app/options.hpp"

#include <stop_token>

namespace edgesplat::app {

/// One run of the robot: reads configuration and rig, wires the stages, runs until the input ends or `stop`
/// is requested, then writes the run folder. Errors: kInvalidConfig (exit code 2), everything else 1.
[[nodiscard]] Status run_robot(const Options& options, const std::stop_token& stop);

}  // namespace edgesplat::app
