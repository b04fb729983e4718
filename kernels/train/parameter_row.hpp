// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace edgesplat::train {

/// One Gaussian's parameters as a run of floats: mean 3, log scale 3, quaternion 4, opacity logit 1, SH 3 a
/// term. Gradients and the optimiser's moments are kept in such rows, padded to whole vectors of 16 (SH
/// degree 0 has 14 of them), so that a row is one to four vector operations and rows come and go as one block
/// of memory.
struct ParameterRow {
  static constexpr std::size_t kMean = 0;
  static constexpr std::size_t kLogScale = 3;
  static constexpr std::size_t kQuat = 6;
  static constexpr std::size_t kOpacity = 10;
  static constexpr std::size_t kSh = 11;
  static constexpr std::size_t kLanes = 16;

  [[nodiscard]] static constexpr std::size_t sh_floats(int sh_degree) {
    return static_cast<std::size_t>(3 * (sh_degree + 1) * (sh_degree + 1));
  }
  [[nodiscard]] static constexpr std::size_t size(int sh_degree) { return kSh + sh_floats(sh_degree); }
  [[nodiscard]] static constexpr std::size_t stride(int sh_degree) {
    return (size(sh_degree) + kLanes - 1) / kLanes * kLanes;
  }
  static constexpr std::size_t kMaxStride = 64;
};

}  // namespace edgesplat::train
