// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/ingest/ingest.hpp"
#include "server/store/keyframe_log.hpp"
#include "server/store/map_file.hpp"

#include <span>
#include <vector>

namespace edgesplat::app {

/// What an earlier server took after it saved for the last time: of each robot's last session in the log, the
/// keyframes that its saved map does not have, oldest first, once each, the newest 512. Those that no longer
/// decode are said and left out. `logged`: oldest first.
[[nodiscard]] std::vector<ingest::IngestedKeyframe> unsaved_keyframes(
    std::span<const store::LoggedKeyframe> logged, std::span<const store::StoredMap> saved);

}  // namespace edgesplat::app
