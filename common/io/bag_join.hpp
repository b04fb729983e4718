// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/io/bag_source.hpp"

#include <memory>
#include <vector>

/// Inside common/io only.
namespace edgesplat::io {

/// Several files as one recording in time order; topics of the same name, type and encoding are one. A file
/// is read from when its first message is due.
[[nodiscard]] std::unique_ptr<BagSource> join_bags(std::vector<std::unique_ptr<BagSource>> parts);

}  // namespace edgesplat::io
