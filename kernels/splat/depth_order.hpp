// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/project.hpp"

#include <cstdint>
#include <vector>

namespace edgesplat::splat {

/// Nearest first, ties in the order given. Depths must be positive. `other` is memory to work in.
void sort_by_depth(std::vector<DepthKey>& keys, std::vector<DepthKey>& other);

}  // namespace edgesplat::splat
