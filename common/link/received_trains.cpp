// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/ack.hpp"

namespace edgesplat::link {

bool ReceivedTrains::is_new(std::uint32_t train) const {
  if (train < next_) return false;
  const std::uint32_t offset = train - next_;
  return offset >= kWindow || (((received_ | given_up_) >> offset) & 1U) == 0;
}

void ReceivedTrains::received(std::uint32_t train) {
  if (!is_new(train)) return;
  make_window_reach(train);
  received_ |= std::uint64_t{1} << (train - next_);
  ++received_total_;
  shift_settled();
}

void ReceivedTrains::give_up(std::uint32_t train) {
  if (!is_new(train)) return;
  make_window_reach(train);
  given_up_ |= std::uint64_t{1} << (train - next_);
  ++lost_total_;
  shift_settled();
}

void ReceivedTrains::make_window_reach(std::uint32_t train) {
  if (train - next_ < kWindow) return;
  const bool first = received_total_ == 0 && lost_total_ == 0;
  const std::uint32_t shift = train - next_ - (kWindow - 1);
  for (std::uint32_t i = 0; i < shift && i < kWindow; ++i) {
    if (!first && (((received_ | given_up_) >> i) & 1U) == 0) ++lost_total_;
  }
  if (!first && shift > kWindow) lost_total_ += shift - kWindow;
  received_ = shift < kWindow ? received_ >> shift : 0;
  given_up_ = shift < kWindow ? given_up_ >> shift : 0;
  next_ += shift;
}

void ReceivedTrains::shift_settled() {
  while (((received_ | given_up_) & 1U) != 0) {
    received_ >>= 1U;
    given_up_ >>= 1U;
    ++next_;
  }
}

}  // namespace edgesplat::link
