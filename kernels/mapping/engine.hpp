// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/densify.hpp"
#include "kernels/mapping/hole_fill.hpp"
#include "kernels/mapping/moving.hpp"
#include "kernels/mapping/optimiser.hpp"
#include "kernels/mapping/plane_sweep.hpp"
#include "kernels/mapping/seed.hpp"
#include "kernels/mapping/seen_through.hpp"
#include "kernels/mapping/view_pool.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace edgesplat::mapping {

/// A live map gets some ten steps a view, not hundreds: larger ones pay (measured with map_quality).
[[nodiscard]] inline OptimiserOptions live_optimiser() {
  OptimiserOptions options;
  options.rates.mean_m = 1e-3F;
  options.rates.log_scale = 2e-2F;
  options.rates.sh_base = 2e-2F;
  options.rates.opacity_logit = 6e-2F;
  options.gap_factor = 0.1F;
  return options;
}

/// The LiDAR seeds densely; growing early only spends the steps there are (18.3 dB against 19.8 dB).
[[nodiscard]] inline DensifyOptions prune_only() {
  DensifyOptions options;
  options.gradient = 1e-2F;
  return options;
}

struct EngineOptions {
  SeedOptions seed;
  HoleFillOptions fill;
  SweepOptions sweep;
  SeenThroughOptions seen_through;
  MovingOptions moving;
  OptimiserOptions optimiser = live_optimiser();
  ViewPoolOptions views;
  DensifyOptions densify = prune_only();
  /// Pictures with more pixels are trained on at half, a third, ... of their size, 1000..1e9
  std::size_t most_pixels = 350'000;
  int densify_every = 100;  ///< steps, 0 (never)..100000
  int steps_per_view =
      300;  ///< after so many a view on average, a map that gets no new one is at rest, 1..1000000
  bool keep_seeds = false;  ///< keep the map as it was seeded, to compare with
};

/// What became of the map since the last question.
struct EngineChanges {
  std::vector<std::uint32_t> changed_rows;  ///< of cloud(): new or other, ascending
  std::vector<gaussian::GaussianId> removed;
};

/// The mapping engine of server and robot: keyframes in, Gaussians that look like their pictures out. Seeds
/// from LiDAR, then one optimisation step a call; the caller bounds the time. No I/O, no threads of its own
/// beyond those of a step. Deterministic. Single-owner.
class MappingEngine {
 public:
  /// `ids` and `clock` must outlive the engine. kInvalidConfig for options out of range.
  static Result<std::unique_ptr<MappingEngine>> create(const EngineOptions& options, IdAllocator& ids,
                                                       const Clock& clock);

  /// Goes on with a map made before: its Gaussians as they are, their places covered; what it was trained on
  /// is not there any more. Before the first add(). Returns how many there was room for. kInvalidArgument,
  /// and nothing taken, for arrays that disagree or a higher SH degree than the options'.
  Result<std::size_t> restore(const gaussian::GaussianCloud& cloud);
  /// Gaussians that somebody else holds and that are drawn together with these (in the same frame): nothing
  /// is seeded where they are, and what they fill of a picture is not trained on. Counts for keyframes added
  /// from now on; null for none.
  void set_elsewhere(std::shared_ptr<const gaussian::GaussianCloud> elsewhere);
  /// Seeds what the keyframe shows anew and keeps its picture to train on. `picture`: the keyframe's,
  /// decoded; null where it has none: then it only seeds. Returns how many Gaussians are new.
  /// kInvalidArgument for a picture of another size than the camera's (the points are seeded all the same).
  Result<std::size_t> add(const map::Keyframe& keyframe, const geometry::RigidTransform& map_from_body,
                          const sensor::ImageRgb8* picture);

  /// There is something to train on and it is not at rest.
  [[nodiscard]] bool has_work() const;
  /// One step on the view whose turn it is. Nothing where there is no view.
  std::optional<StepReport> step();

  [[nodiscard]] EngineChanges take_changes();
  /// The pictures trained on, oldest first, to go on with them in another engine; none is left here.
  [[nodiscard]] std::deque<StoredView> take_views() { return views_.take_all(); }
  void add_view(StoredView view) { views_.add(std::move(view)); }
  [[nodiscard]] const gaussian::GaussianCloud& cloud() const { return optimiser_.cloud(); }
  [[nodiscard]] const gaussian::GaussianCloud& seeds() const { return seeds_; }
  [[nodiscard]] const SeedStats& seed_stats() const { return seeder_.stats(); }
  [[nodiscard]] const ViewPool& views() const { return views_; }
  [[nodiscard]] std::uint64_t steps() const { return steps_; }
  /// Why steps are not taken on the GPU any more; empty while nothing failed there.
  [[nodiscard]] const std::string& gpu_failure() const { return optimiser_.gpu_failure(); }
  /// Gaussians removed because something was measured behind them.
  [[nodiscard]] std::uint64_t gone() const { return gone_; }

 private:
  MappingEngine(const EngineOptions& options, IdAllocator& ids, Optimiser optimiser)
      : options_(options),
        ids_(ids),
        seeder_(options.seed, ids),
        optimiser_(std::move(optimiser)),
        views_(options.views) {}
  Result<std::size_t> seed(const SeedInput& input);
  /// How much of the view's pixels [H,W] these Gaussians fill together with `others` (empty: nothing).
  [[nodiscard]] Result<std::vector<float>> draw_alpha(const StoredView& view,
                                                      const gaussian::GaussianCloud& cloud,
                                                      std::span<const float> others);
  /// Compares the new view with the ones before it, both ways: hides what moves in all of them, removes the
  /// Gaussians that were made of it, and returns the points that stand still.
  Result<std::vector<map::ColouredPoint>> without_moving(const SeedInput& input, StoredView& view);
  /// What the view's LiDAR looks through goes, and its pixels in the pictures that showed it.
  Status forget_what_is_gone(const StoredView& view);
  Status remove_gone(std::span<const std::uint32_t> rows);
  /// Seeds where the new view is still empty; `others`: what is filled by others, empty for nothing.
  Result<std::size_t> fill_floor(const StoredView& view, const SeedInput& seeded,
                                 std::span<const float> others);
  Result<std::size_t> fill_by_sweep(StoredView& view, const SeedInput& seeded, std::span<const float> others);
  [[nodiscard]] std::shared_ptr<const image::Undistorter> undistorter_of(const geometry::CameraModel& camera);
  [[nodiscard]] TrainingView prepare(const StoredView& view);

  EngineOptions options_;
  IdAllocator& ids_;
  MapSeeder seeder_;
  Optimiser optimiser_;
  ViewPool views_;
  SeenThrough seen_through_{options_.seen_through};
  gaussian::GaussianCloud seeds_;
  std::shared_ptr<const gaussian::GaussianCloud> elsewhere_;
  std::optional<GroundPlane> ground_;            ///< as found last
  std::optional<geometry::CameraModel> camera_;  ///< that undistorter_ is for
  std::shared_ptr<const image::Undistorter> undistorter_;
  ChangeMark taken_ = 0;
  std::vector<gaussian::GaussianId> removed_;
  std::uint64_t steps_ = 0;
  std::uint64_t steps_since_view_ = 0;
  std::uint64_t gone_ = 0;
  std::vector<float> colour_, depth_m_, weight_;  ///< of the view in training
};

}  // namespace edgesplat::mapping
