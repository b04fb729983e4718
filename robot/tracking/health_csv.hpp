// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/tracked_group.hpp"

#include <string>
#include <string_view>

namespace edgesplat::tracking {

/// "tracking", "coasting", ...
[[nodiscard]] std::string_view name_of(TrackingState state);

/// The columns of health_csv(), without a line's end.
[[nodiscard]] std::string_view health_csv_header();
/// A group's health as the columns of a CSV line.
[[nodiscard]] std::string health_csv(const TrackingHealth& health);

}  // namespace edgesplat::tracking
