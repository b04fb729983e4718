// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/prune_switches.hpp"

#include "kernels/train/parameter_row.hpp"
#include "kernels/train/switch_math.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::mapping {

using train::ParameterRow;

void PruneSwitches::append(std::span<const float> drawn_logits) {
  if (!enabled()) return;
  for (std::size_t row = states_.size(); row < drawn_logits.size(); ++row) {
    // A base of sqrt(o) at most: it has a gradient then, however solid the Gaussian is.
    const float drawn = std::min(train::sigmoid(drawn_logits[row]), 0.999F);
    states_.push_back({train::logit_of(std::max(options_.start, std::sqrt(drawn))), 0.0F, 0.0F, 0.0F});
  }
}

void PruneSwitches::keep_rows(std::span<const std::uint32_t> rows) {
  if (!enabled()) return;
  for (std::size_t to = 0; to < rows.size(); ++to) states_[to] = states_[rows[to]];
  states_.resize(rows.size());
}

float PruneSwitches::of(std::size_t row) const {
  return enabled() ? train::sigmoid(states_[row].logit) : 1.0F;
}

void PruneSwitches::step(State& state, float gradient) const {
  constexpr float kBeta1 = 0.9F, kBeta2 = 0.999F, kEpsilon = 1e-15F;
  constexpr float kMostLogit = 12.0F;  ///< w stays within what a float tells from 0 and 1
  state.steps += 1.0F;
  state.first = kBeta1 * state.first + (1.0F - kBeta1) * gradient;
  state.second = kBeta2 * state.second + (1.0F - kBeta2) * gradient * gradient;
  const float first = state.first / (1.0F - std::pow(kBeta1, state.steps));
  const float second = state.second / (1.0F - std::pow(kBeta2, state.steps));
  const float next = state.logit - options_.rate * first / (std::sqrt(second) + kEpsilon);
  if (std::isfinite(next)) state.logit = std::clamp(next, -kMostLogit, kMostLogit);
}

double PruneSwitches::before_step(const train::GradientBlock& block, std::size_t stride, float share,
                                  std::span<float> logits) {
  double cost = 0.0;
  for (std::size_t i = 0; i < block.rows.size(); ++i) {
    const std::size_t row = block.rows[i];
    State& state = states_[row];
    float& by_logit = block.values[i * stride + ParameterRow::kOpacity];
    const float base = train::base_logit(logits[row], state.logit);
    const auto by = train::switch_backward(base, state.logit, by_logit);
    const float factor = options_.factor * share;
    cost += static_cast<double>(factor * train::sigmoid(state.logit));
    step(state, by.switched + train::switch_cost_backward(state.logit, factor));
    logits[row] = base;
    by_logit = by.base;
  }
  return cost;
}

void PruneSwitches::after_step(const train::GradientBlock& block, std::span<float> logits) const {
  for (const std::uint32_t row : block.rows)
    logits[row] = train::switched_logit(logits[row], states_[row].logit);
}

}  // namespace edgesplat::mapping
