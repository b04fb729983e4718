// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace edgesplat::local_mapping {

/// How much of the robot its own mapping may take.
struct LocalMappingConfig {
  bool enabled = true;
  double core_share = 0.3;  ///< of one core, taken by keyframes and steps together, 0.01..1
  std::size_t budget_bytes = std::size_t{64}
                             << 20U;  ///< Gaussians with all they need, and training pictures, 2^20..2^40
  std::size_t queue_keyframes = 8;    ///< waiting to be mapped, oldest dropped first, 1..256
  double publish_period_s = 0.5;      ///< least time between two maps given to the renderer, 0..10
  int lockstep_steps = 8;             ///< after each keyframe of a lockstep run, 0..10000
  std::size_t views_when_short = 4;   ///< newest pictures that pruning leaves, 1..64

  /// Of the Gaussians; the rest is for pictures.
  [[nodiscard]] std::size_t gaussian_bytes() const { return budget_bytes / 4 * 3; }
  [[nodiscard]] std::size_t view_bytes() const { return budget_bytes - gaussian_bytes(); }
};

}  // namespace edgesplat::local_mapping
