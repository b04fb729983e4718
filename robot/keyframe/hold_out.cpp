// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/hold_out.hpp"

namespace edgesplat::keyframe {

std::optional<int> HoldOut::block_of(HostTime stamp) {
  if (!first_) first_ = stamp;
  // A block that should have begun during another one begins when that is over.
  if (left_in_block_ == 0 && next_block_ < from_s_.size() &&
      stamp - *first_ >= from_seconds(from_s_[next_block_])) {
    ++next_block_;
    left_in_block_ = pictures_;
  }
  if (left_in_block_ == 0) return std::nullopt;
  --left_in_block_;
  return static_cast<int>(next_block_) - 1;
}

}  // namespace edgesplat::keyframe
