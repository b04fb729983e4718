// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace edgesplat::app {

/// Keeps a bounded, evenly spread sample of a sequence of unknown length: when full, every other one is let
/// go and the stride doubles. Single-owner.
template <typename T>
class EvenSample {
 public:
  /// `most` > 0.
  explicit EvenSample(std::size_t most) : most_(most) {}

  void add(T item) {
    if (seen_++ % stride_ != 0) return;
    if (kept_.size() >= most_) {
      for (std::size_t i = 0; 2 * i < kept_.size(); ++i) kept_[i] = std::move(kept_[2 * i]);
      kept_.resize((kept_.size() + 1) / 2);
      stride_ *= 2;
      if ((seen_ - 1) % stride_ != 0) return;
    }
    kept_.push_back(std::move(item));
  }
  [[nodiscard]] const std::vector<T>& kept() const { return kept_; }

 private:
  std::size_t most_;
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;
  std::vector<T> kept_;
};

}  // namespace edgesplat::app
