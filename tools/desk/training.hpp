// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "common/time/clock.hpp"
#include "kernels/mapping/schedule.hpp"
#include "kernels/mapping/view_order.hpp"
#include "tools/desk/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace edgesplat::desk {

enum class Densify {
  kGradient,  ///< clone and split where pictures disagree (mapping::densify)
  kMcmc,      ///< relocate what is dead and grow by sampling (mapping::Relocator)
};

/// How long and how a map is fitted to a scene's pictures. The schedule runs with progress, 0..1: the larger
/// of the shares of iterations and of seconds that are used up.
struct TrainingOptions {
  std::uint64_t iterations = 0;  ///< pictures looked at; 0: only `seconds` ends it
  double seconds = 0.0;          ///< of training; 0: only `iterations` ends it
  /// The map grows to this, by the same factor in equal times, until 0.8 of schedule.grow_until. 0: one for
  /// every 48 pixels of the pictures, 300 000 at most, and 40 for every step that there is time for, but half
  /// as many again as there are at the start
  std::size_t max_gaussians = 0;
  std::size_t max_start_points = 40'000;  ///< of the scene's points, evenly taken; growth makes the others
  Densify densify = Densify::kGradient;
  std::uint64_t densify_every = 100;  ///< iterations
  /// What is best on simulated and real scenes of this size at 7 to 60 s (docs/benchmarks.md).
  mapping::ScheduleOptions schedule{.coarse_until = 0.25, .cool_from = 0.5};
  std::size_t coarse_rounds = 15;  ///< small pictures say nothing more after so many looks at each of them
  mapping::ViewOrderOptions views;
  float rate_factor = 2.0F;     ///< of all learning rates; short trainings want more, 0.1..10
  float depth_factor = 0.0F;    ///< of the depth loss, where pictures have depth, 0 (off)..1
  float opacity_factor = 0.0F;  ///< of the mean opacity of what a picture shows, 0..0.1
  float scale_factor = 0.0F;    ///< of the mean scale, in shares of the scene's extent, 0..1
  float prune_factor = 0.0F;    ///< of the mean switch of differentiable pruning, 0 (off)..1
  float start_opacity = 0.1F;   ///< of the Gaussians made of points, 0.01..0.9
  bool fill_gaps = true;        ///< Gaussians where pictures see what no point stands for (start_gaps.hpp)
  bool learn_exposure = false;  ///< gain and offset of each training picture

  /// kInvalidConfig for a training without an end and values out of range.
  [[nodiscard]] Status validate() const;
};

struct TrainingProgress {
  std::uint64_t iterations = 0;
  double seconds = 0.0;
  double loss = 0.0;  ///< mean of the latest pictures
  std::size_t gaussians = 0;
};

/// What somebody wants to hear of a training while it runs. Both may be empty.
struct TrainingWatch {
  std::function<void(const TrainingProgress&)> tell;  ///< about once a second
  /// Called with the map (in the scene's units) when training first has taken each of `look_at_s` (ascending,
  /// s), and at the end. The time that it takes does not count as training. An error ends the training.
  std::function<Status(const TrainingProgress&, const gaussian::GaussianCloud&)> look;
  std::vector<double> look_at_s;
};

struct TrainedMap {
  gaussian::GaussianCloud map;
  std::uint64_t iterations = 0;
  double seconds = 0.0;  ///< of the iterations alone
};

/// Fits Gaussians, starting from `points`, to the pictures, one picture an iteration in shuffled rounds. The
/// same input gives the same map if `seconds` is 0. Errors: kInvalidConfig (options), kInvalidArgument (no
/// picture, fewer than 10 points), those of the watch.
[[nodiscard]] Result<TrainedMap> train_map(std::span<const ScenePicture* const> pictures,
                                           const io::PointCloud& points, const TrainingOptions& options,
                                           const Clock& clock, const TrainingWatch& watch = {});

}  // namespace edgesplat::desk
