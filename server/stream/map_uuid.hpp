// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/ids.hpp"

namespace edgesplat::stream {

/// A new name for a map, from the system's random source.
[[nodiscard]] map::MapUuid make_map_uuid();

}  // namespace edgesplat::stream
