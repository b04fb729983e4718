// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/view_pool.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace edgesplat::mapping {

std::uint32_t ViewPool::draw(std::uint32_t below) {
  state_ ^= state_ << 13U;  // Marsaglia 2003, xorshift64
  state_ ^= state_ >> 7U;
  state_ ^= state_ << 17U;
  return static_cast<std::uint32_t>((state_ >> 32U) * below >> 32U);
}

void ViewPool::add(StoredView view) {
  bytes_ += view.size_bytes();
  views_.push_back(std::move(view));
  if (bytes_ > options_.max_bytes) thin_out();
}

std::deque<StoredView> ViewPool::take_all() {
  round_.clear();
  bytes_ = 0;
  return std::exchange(views_, {});
}

void ViewPool::thin_out() {
  const std::size_t keep_newest = std::min(options_.recent, views_.size());
  std::deque<StoredView> kept;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    if (i % 2 == 0 || i + keep_newest >= views_.size()) {
      kept.push_back(std::move(views_[i]));
    } else {
      ++dropped_;
    }
  }
  views_ = std::move(kept);
  // Where even the newest do not fit, the oldest of them go.
  const auto total = [&] {
    return std::accumulate(views_.begin(), views_.end(), std::size_t{0},
                           [](std::size_t sum, const StoredView& v) { return sum + v.size_bytes(); });
  };
  bytes_ = total();
  while (bytes_ > options_.max_bytes && views_.size() > 1) {
    views_.pop_front();
    ++dropped_;
    bytes_ = total();
  }
  round_.clear();
}

const StoredView* ViewPool::next() {
  if (views_.empty()) return nullptr;
  constexpr std::uint32_t kWhole = 1U << 16U;
  const auto recent = static_cast<std::uint32_t>(std::min(options_.recent, views_.size()));
  if (recent > 0 && static_cast<float>(draw(kWhole)) < options_.recent_share * static_cast<float>(kWhole)) {
    return &views_[views_.size() - 1 - draw(recent)];
  }
  if (round_.empty()) {
    round_.resize(views_.size());
    std::iota(round_.begin(), round_.end(), 0U);
    for (std::uint32_t i = static_cast<std::uint32_t>(round_.size()); i > 1; --i) {
      std::swap(round_[i - 1], round_[draw(i)]);
    }
  }
  const std::uint32_t row = round_.back();
  round_.pop_back();
  return &views_[row];
}

}  // namespace edgesplat::mapping
