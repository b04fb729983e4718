// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::mapping {

/// A moment in the life of a map; later ones are greater.
using ChangeMark = std::uint64_t;

/// When each row changed last, so that only what changed is streamed. Single-owner.
class RowChanges {
 public:
  /// Everything that changed up to here is no later than this mark.
  [[nodiscard]] ChangeMark mark() const { return now_; }
  /// Starts a change: rows touched from now on are later than any mark taken before.
  void begin() { ++now_; }
  /// Rows of one change may be touched by several threads, each its own.
  void touch(std::size_t row) { changed_at_[row] = now_; }
  /// New rows count as touched.
  void resize(std::size_t rows) { changed_at_.resize(rows, now_); }
  /// Keeps the given rows, ascending.
  void keep_rows(std::span<const std::uint32_t> rows) {
    for (std::size_t to = 0; to < rows.size(); ++to) changed_at_[to] = changed_at_[rows[to]];
    changed_at_.resize(rows.size());
  }
  /// Rows that changed after the mark was taken, ascending.
  [[nodiscard]] std::vector<std::uint32_t> since(ChangeMark mark) const {
    std::vector<std::uint32_t> rows;
    for (std::size_t row = 0; row < changed_at_.size(); ++row)
      if (changed_at_[row] > mark) rows.push_back(static_cast<std::uint32_t>(row));
    return rows;
  }

 private:
  ChangeMark now_ = 0;
  std::vector<ChangeMark> changed_at_;
};

}  // namespace edgesplat::mapping
