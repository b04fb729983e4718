// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "common/time/clock.hpp"
#include "tools/desk/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace edgesplat::desk {

/// How long and how a map is fitted to a scene's pictures. The schedule runs with progress, 0..1: the larger
/// of the shares of iterations and of seconds that are used up.
struct TrainingOptions {
  std::uint64_t iterations = 0;  ///< pictures looked at; 0: only `seconds` ends it
  double seconds = 0.0;          ///< of training; 0: only `iterations` ends it
  int sh_degree = 3;             ///< 0..3
  std::size_t max_gaussians = 300'000;
  std::size_t max_start_points = 100'000;
  std::uint64_t densify_every = 100;  ///< iterations
  double densify_until = 0.6;         ///< progress
  bool learn_exposure = false;        ///< gain and offset of each training picture

  /// kInvalidConfig for a training without an end and values out of range.
  [[nodiscard]] Status validate() const;
};

struct TrainingProgress {
  std::uint64_t iterations = 0;
  double seconds = 0.0;
  double loss = 0.0;  ///< mean of the latest pictures
  std::size_t gaussians = 0;
};

struct TrainedMap {
  gaussian::GaussianCloud map;
  std::uint64_t iterations = 0;
  double seconds = 0.0;  ///< of the iterations alone
};

/// Fits Gaussians, starting from `points`, to the pictures, one picture an iteration in shuffled rounds. The
/// same input gives the same map if `seconds` is 0. `tell` is called about once a second. Errors:
/// kInvalidConfig (options), kInvalidArgument (no picture, fewer than 10 points).
[[nodiscard]] Result<TrainedMap> train_map(std::span<const ScenePicture* const> pictures,
                                           const io::PointCloud& points, const TrainingOptions& options,
                                           const Clock& clock,
                                           const std::function<void(const TrainingProgress&)>& tell);

}  // namespace edgesplat::desk
