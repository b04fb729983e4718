// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/view_order.hpp"

#include <cmath>
#include <numeric>
#include <utility>

namespace edgesplat::mapping {

ViewOrder::ViewOrder(std::size_t count, const ViewOrderOptions& options)
    : options_(options), losses_(count, 0.0), random_(options.seed) {}

std::size_t ViewOrder::next() {
  if (round_.empty()) begin_round();
  const std::size_t view = round_.back();
  round_.pop_back();
  return view;
}

void ViewOrder::tell(std::size_t view, double loss) {
  if (std::isfinite(loss) && loss >= 0.0) losses_[view] = loss;
}

void ViewOrder::begin_round() {
  round_.resize(losses_.size());
  std::iota(round_.begin(), round_.end(), std::size_t{0});
  const auto extra = static_cast<std::size_t>(options_.loss_share * static_cast<float>(losses_.size()));
  for (std::size_t i = 0; i < extra; ++i) round_.push_back(draw_by_loss());
  // Not std::shuffle: its result differs between libraries.
  for (std::size_t i = round_.size(); i > 1; --i) std::swap(round_[i - 1], round_[random_() % i]);
}

std::size_t ViewOrder::draw_by_loss() {
  const double sum = std::accumulate(losses_.begin(), losses_.end(), 0.0);
  if (sum <= 0.0) return random_() % losses_.size();
  double rest = sum * (static_cast<double>(random_()) / 4294967296.0);
  for (std::size_t view = 0; view < losses_.size(); ++view) {
    rest -= losses_[view];
    if (rest < 0.0) return view;
  }
  return losses_.size() - 1;
}

}  // namespace edgesplat::mapping
