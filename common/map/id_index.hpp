// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/gaussian/gaussian_id.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace edgesplat::map {

/// Row of each Gaussian, by id: a flat hash table, 16 bytes a slot, at most 3/4 full. Single-owner.
class IdIndex {
 public:
  [[nodiscard]] std::optional<std::uint32_t> find(gaussian::GaussianId id) const;
  /// Sets the row of an id, new or known.
  void set(gaussian::GaussianId id, std::uint32_t row);
  void erase(gaussian::GaussianId id);
  void clear();
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t bytes() const { return slots_.size() * sizeof(Slot); }

 private:
  static constexpr std::uint32_t kFree = 0xFFFFFFFFU;
  struct Slot {
    std::uint64_t id = 0;
    std::uint32_t row = kFree;
  };
  [[nodiscard]] std::size_t home(std::uint64_t id) const;
  /// Of the id, or the free one where it would go.
  [[nodiscard]] std::size_t slot_of(std::uint64_t id) const;
  void grow();

  std::vector<Slot> slots_;  ///< a power of two of them, or none
  std::size_t size_ = 0;
};

}  // namespace edgesplat::map
