// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/keyframe.hpp"

#include <memory>

namespace edgesplat::offload {

/// The robot's own mapping: what it does while the server does not (architecture.md, "What runs where").
class LocalMapping {
 public:
  virtual ~LocalMapping() = default;
  /// In LOCAL the map is grown and optimised here, in the other modes by the server. `prune_and_compress`:
  /// the robot is over its limits and the link is too narrow to offload (Algorithm 1, line 8). Called on the
  /// thread that decides, after every evaluation; must return at once.
  virtual void set_work(bool map_here, bool prune_and_compress) = 0;
  /// A keyframe made while the mode is LOCAL. Called on the robot's keyframe thread; must return at once.
  virtual void submit(std::shared_ptr<const map::Keyframe> keyframe) = 0;
};

}  // namespace edgesplat::offload
