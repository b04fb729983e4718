// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace edgesplat::mapping {

struct ViewOrderOptions {
  /// So many more turns as a share of a round go to the views with the greatest losses, drawn in proportion
  /// to them, 0..10; 0: plain rounds
  float loss_share = 0.0F;
  std::uint32_t seed = 1;
};

/// Which view of a fixed set is trained on next: every view once in a shuffled round, so that none is
/// forgotten, and those that the map shows badly again. Deterministic. Single-owner.
class ViewOrder {
 public:
  /// `count` >= 1.
  ViewOrder(std::size_t count, const ViewOrderOptions& options);

  [[nodiscard]] std::size_t next();
  /// The loss that a step at this view had; one that is not finite or below 0 is ignored.
  void tell(std::size_t view, double loss);

 private:
  void begin_round();
  [[nodiscard]] std::size_t draw_by_loss();

  ViewOrderOptions options_;
  std::vector<double> losses_;      ///< last known, 0: unknown
  std::vector<std::size_t> round_;  ///< still to come, last first
  std::mt19937 random_;
};

}  // namespace edgesplat::mapping
