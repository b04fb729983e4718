// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace edgesplat::tracking {

/// Objects addressed by index, freed slots reused last-in first-out (so that equal histories give equal
/// indices). Single-owner.
template <typename T>
class IndexPool {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  std::uint32_t allocate() {
    if (free_.empty()) {
      items_.emplace_back();
      return static_cast<std::uint32_t>(items_.size() - 1);
    }
    const std::uint32_t index = free_.back();
    free_.pop_back();
    items_[index] = T{};
    return index;
  }
  void release(std::uint32_t index) { free_.push_back(index); }
  T& operator[](std::uint32_t index) { return items_[index]; }
  const T& operator[](std::uint32_t index) const { return items_[index]; }
  [[nodiscard]] std::size_t slots() const { return items_.size(); }
  [[nodiscard]] std::size_t live() const { return items_.size() - free_.size(); }
  [[nodiscard]] std::size_t live_bytes() const { return live() * sizeof(T); }

 private:
  std::vector<T> items_;
  std::vector<std::uint32_t> free_;
};

}  // namespace edgesplat::tracking
