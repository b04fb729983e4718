// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <stop_token>

namespace edgesplat::thread {

/// Sleeps for `how_long`, or until a stop is requested.
void pause(const std::stop_token& stop, std::chrono::nanoseconds how_long);

}  // namespace edgesplat::thread
