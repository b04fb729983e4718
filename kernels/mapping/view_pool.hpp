// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/stored_view.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace edgesplat::mapping {

struct ViewPoolOptions {
  std::size_t max_bytes = std::size_t{512} << 20U;  ///< of pictures and depths
  std::size_t recent = 8;                           ///< the newest views, which get ...
  float recent_share = 0.6F;  ///< ... this share of the steps on top of their turn, 0..1
};

/// The views a map is trained on, bounded in bytes, and whose turn it is: the newest often, so that what the
/// robot sees now is good soon, and all in a shuffled round, so that nothing is forgotten. When full, every
/// other of the older views is let go. Deterministic. Single-owner.
class ViewPool {
 public:
  explicit ViewPool(const ViewPoolOptions& options) : options_(options) {}

  void add(StoredView view);
  /// All, oldest first, leaving none: to go on with them in another pool.
  [[nodiscard]] std::deque<StoredView> take_all();
  /// The view to train on next; null for an empty pool. Valid until the next add().
  [[nodiscard]] const StoredView* next();
  [[nodiscard]] std::size_t size() const { return views_.size(); }
  [[nodiscard]] std::size_t size_bytes() const { return bytes_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  /// All, oldest first; poses may be corrected in place.
  [[nodiscard]] std::deque<StoredView>& views() { return views_; }

 private:
  [[nodiscard]] std::uint32_t draw(std::uint32_t below);
  void thin_out();

  ViewPoolOptions options_;
  std::deque<StoredView> views_;
  std::size_t bytes_ = 0;
  std::uint64_t dropped_ = 0;
  std::vector<std::uint32_t> round_;  ///< rows still to come in this round, last first
  std::uint64_t state_ = 0x9E3779B97F4A7C15ULL;
};

}  // namespace edgesplat::mapping
