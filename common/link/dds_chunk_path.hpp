// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/chunk_path.hpp"
#include "common/link/dds_domain.hpp"

#include <functional>
#include <memory>

namespace edgesplat::link {

/// Chunks over Cyclone DDS: a topic a lane and direction. `wake` is called on Cyclone's own threads when data
/// or peers came or went and must return at once. Errors: kUnavailable with the reason where DDS refuses.
[[nodiscard]] Result<std::unique_ptr<ChunkPath>> open_dds_path(std::shared_ptr<DdsDomain> domain, Role role,
                                                               std::function<void()> wake);

}  // namespace edgesplat::link
