// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/train/gaussian_backward.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::mapping {

struct PruneOptions {
  float factor = 0.0F;       ///< of the mean switch of what a picture shows, 0 (no switches)..10
  float rate = 5e-2F;        ///< of Adam, for the switches' logits, 1e-3..1
  float start = 0.9F;        ///< how far open switches start, 0.5..0.99
  float min_switch = 0.05F;  ///< less open, a Gaussian is to be removed, 0..0.5
};

/// Differentiable pruning (Fig. 2 of the edgesplat paper, "gradient game"): every Gaussian's opacity is
/// multiplied by w = sigmoid(m). The loss pulls w up where the picture needs the Gaussian, a cost on w pulls
/// all down; who loses is removed by densify() or Relocator. What is drawn, w times the base, is what the
/// cloud holds, so that everything else - renderer, deltas, files - knows nothing of switches; the base is
/// worked out from it when a row steps. Single-owner, but rows of different blocks may step on different
/// threads at once.
class PruneSwitches {
 public:
  explicit PruneSwitches(const PruneOptions& options) : options_(options) {}

  [[nodiscard]] bool enabled() const { return options_.factor > 0.0F; }
  /// New rows at the end of `drawn_logits` [N] start with switches open enough for what they show.
  void append(std::span<const float> drawn_logits);
  /// Keeps the given rows, ascending.
  void keep_rows(std::span<const std::uint32_t> rows);
  void forget_moments(std::size_t row) { states_[row].first = states_[row].second = states_[row].steps = 0; }
  /// w of a row.
  [[nodiscard]] float of(std::size_t row) const;
  /// Rows are to be removed where their switch is less open than this; 0 without switches.
  [[nodiscard]] float least() const { return enabled() ? options_.min_switch : 0.0F; }

  /// Before Adam steps a block: the cloud's logits of its rows become those of the base, and the gradients by
  /// them too; the switches step. `share` is one over the rows that the picture shows. Returns what the
  /// switches cost.
  double before_step(const train::GradientBlock& block, std::size_t stride, float share,
                     std::span<float> logits);
  /// After it: what is drawn again.
  void after_step(const train::GradientBlock& block, std::span<float> logits) const;

 private:
  struct State {
    float logit;
    float first, second, steps;  ///< of Adam
  };
  void step(State& state, float gradient) const;

  PruneOptions options_;
  std::vector<State> states_;
};

}  // namespace edgesplat::mapping
