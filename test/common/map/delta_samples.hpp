// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/delta.hpp"

#include <cstddef>
#include <vector>

namespace edgesplat::test {

/// Robot 12, map 0 1 2 .. 15, epoch 3, delta 1000 on 999.
[[nodiscard]] map::DeltaHeader sample_header();

/// One delta of each kind, in the order of DeltaKind, with `count` Gaussians where there are any.
[[nodiscard]] std::vector<map::Delta> all_kinds(std::size_t count);

[[nodiscard]] bool same_rows(const map::QuantisedRows& a, const map::QuantisedRows& b);

}  // namespace edgesplat::test
