// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/simd_level.hpp"

namespace edgesplat::test {

/// While it lives the CPU backend uses no wider vectors than these.
class SimdLimit {
 public:
  explicit SimdLimit(core::SimdLevel most) { core::limit_simd_level(most); }
  ~SimdLimit() { core::limit_simd_level(core::available_simd_levels().back()); }
  SimdLimit(const SimdLimit&) = delete;
  SimdLimit& operator=(const SimdLimit&) = delete;
};

}  // namespace edgesplat::test
