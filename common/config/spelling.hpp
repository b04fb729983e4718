// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::config {

/// The candidate nearest to `word` by edit distance, or "" where none is near enough to be a slip of the
/// hand (a third of the word's length, or a candidate whose unit is missing: "voxel_size").
[[nodiscard]] std::string nearest_spelling(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace edgesplat::config
