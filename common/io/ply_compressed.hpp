// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_cloud.hpp"
#include "common/io/ply_table.hpp"

/// PlayCanvas' compressed PLY, read only: chunks of 256 Gaussians with ranges, four packed words each. Inside
/// common/io only.
namespace edgesplat::io::ply {

[[nodiscard]] bool is_compressed(const File& file);
/// kCorrupt with the reason. Layout: github.com/playcanvas/splat-transform (MIT).
[[nodiscard]] Result<gaussian::GaussianCloud> parse_compressed(const File& file);

/// SH degree by the number of f_rest_* columns; kCorrupt for a number that fits none.
[[nodiscard]] Result<int> degree_of_rest_columns(const Table& table);

}  // namespace edgesplat::io::ply
