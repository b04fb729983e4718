// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_id.hpp"

#include <cstdint>

namespace edgesplat::mapping {

/// Gives every Gaussian that one instance makes its name. Single-owner.
class IdAllocator {
 public:
  /// `first_counter`: nothing below was ever given out by this origin.
  explicit IdAllocator(std::uint16_t origin, std::uint64_t first_counter = 1)
      : origin_(origin), next_(first_counter) {}
  [[nodiscard]] gaussian::GaussianId next() { return {origin_, next_++}; }
  [[nodiscard]] std::uint64_t next_counter() const { return next_; }

 private:
  std::uint16_t origin_;
  std::uint64_t next_;
};

}  // namespace edgesplat::mapping
