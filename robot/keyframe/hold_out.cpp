// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/keyframe/hold_out.hpp"

namespace edgesplat::keyframe {

bool HoldOut::takes(HostTime stamp) {
  if (!first_) first_ = stamp;
  // A block that should have begun during another one begins when that is over.
  if (left_in_block_ == 0 && next_block_ < from_s_.size() &&
      stamp - *first_ >= from_seconds(from_s_[next_block_])) {
    ++next_block_;
    left_in_block_ = pictures_;
  }
  if (left_in_block_ == 0) return false;
  --left_in_block_;
  return true;
}

}  // namespace edgesplat::keyframe
