// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace edgesplat::stream {

/// The last encoded deltas, numbered without gaps, for those that a robot missed: the oldest give way to a
/// new one over either bound. Single-owner.
class DeltaRing {
 public:
  DeltaRing(std::size_t max_deltas, std::size_t max_bytes) : max_deltas_(max_deltas), max_bytes_(max_bytes) {}

  /// `seq` is one more than the last.
  void push(std::uint64_t seq, std::vector<std::byte> bytes);
  [[nodiscard]] bool holds(std::uint64_t seq) const;
  /// Which must be held.
  [[nodiscard]] std::span<const std::byte> at(std::uint64_t seq) const;
  [[nodiscard]] std::size_t size() const { return deltas_.size(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  std::size_t max_deltas_;
  std::size_t max_bytes_;
  std::deque<std::vector<std::byte>> deltas_;
  std::uint64_t first_seq_ = 1;
  std::size_t bytes_ = 0;
};

}  // namespace edgesplat::stream
