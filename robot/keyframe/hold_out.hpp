// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"
#include "robot/keyframe/keyframe_config.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace edgesplat::keyframe {

/// Which pictures of a run are kept from the map, so that it can be judged by them afterwards: blocks of so
/// many in a row, each beginning with the first picture that is so long after the first of all. Single-owner.
class HoldOut {
 public:
  explicit HoldOut(const KeyframeConfig& config)
      : from_s_(config.hold_out_from_s), pictures_(config.hold_out_pictures) {}

  /// To be asked once for every picture, in the order of their stamps: the number of the block that it
  /// belongs to, counted from 0; nothing for a picture that the map gets.
  [[nodiscard]] std::optional<int> block_of(HostTime stamp);

 private:
  std::vector<double> from_s_;
  int pictures_;
  std::optional<HostTime> first_;
  std::size_t next_block_ = 0;
  int left_in_block_ = 0;
};

}  // namespace edgesplat::keyframe
