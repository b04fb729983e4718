// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/line_vector.hpp"
#include "common/gaussian/gaussian_cloud.hpp"
#include "common/time/clock.hpp"
#include "kernels/mapping/optimiser_options.hpp"
#include "kernels/mapping/prune_switches.hpp"
#include "kernels/mapping/row_changes.hpp"
#include "kernels/mapping/row_statistics.hpp"
#include "kernels/mapping/training_view.hpp"
#include "kernels/splat/render.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace edgesplat::mapping {

class StepDevice;

struct StepTimes {
  std::chrono::nanoseconds forward{}, loss{};
  std::chrono::nanoseconds backward{};  ///< from the pictures to the splats
  std::chrono::nanoseconds update{};    ///< from the splats to the Gaussians, and Adam
  [[nodiscard]] std::chrono::nanoseconds total() const { return forward + loss + backward + update; }
};

struct StepReport {
  double loss = 0.0;        ///< what the step went down, before it
  double l1 = 0.0;          ///< mean absolute difference of the colours
  double depth_m = 0.0;     ///< mean absolute difference of the depths, 0 without
  std::size_t visible = 0;  ///< Gaussians that the picture shows: those that moved
  /// dL by the camera's pose: dr, dt with camera_from_map ⊞ (dr, dt) = (rotation Exp(dr), translation + dt)
  std::array<double, 6> by_pose{};
  StepTimes times;
};

/// Fits the map's Gaussians to pictures, one picture a step: draw, compare, go back, move (3DGS, Kerbl 2023).
/// Owns the Gaussians. Starts no thread of its own (TBB within a step), does no I/O, keeps no picture. The
/// caller bounds the time by calling step() until its deadline. Deterministic: the same calls give the same
/// map whatever the number of threads. On a GPU where there is one (`on_gpu`), whose maps differ in rounding;
/// where it fails, its memory being full for instance, steps go on on the CPU with fresh moments.
/// Single-owner.
class Optimiser {
 public:
  ~Optimiser();
  Optimiser(Optimiser&&) noexcept;
  Optimiser& operator=(Optimiser&&) noexcept;
  /// kInvalidConfig for options out of range. `clock` must outlive the optimiser; it only times the steps.
  static Result<Optimiser> create(const OptimiserOptions& options, const Clock& clock);

  [[nodiscard]] const gaussian::GaussianCloud& cloud() const { return cloud_; }
  /// Appends rows (a lower SH degree is padded with zeros) as far as the budget goes, and returns how many;
  /// the rest is refused and counted. kInvalidArgument, and nothing added, for arrays of different lengths or
  /// a higher SH degree.
  Result<std::size_t> add_rows(const gaussian::GaussianCloud& rows);
  /// Removes rows given in any order, once each; the others keep their order. kInvalidArgument, and nothing
  /// removed, for a row that does not exist.
  Status remove_rows(std::span<const std::uint32_t> rows);
  /// Marks rows as changed and gives the cloud for setting their values (a correction of anchors): lengths
  /// and ids must stay.
  gaussian::GaussianCloud& edit_rows(std::span<const std::uint32_t> rows);

  /// Rows get SH of a higher degree, zero at first, so that the map looks as before; all count as changed. On
  /// a GPU moments start afresh.
  /// kInvalidArgument for a lower degree or one above 3.
  Status raise_sh_degree(int sh_degree);
  /// From the next step on; as OptimiserOptions' and not checked again.
  void set_rates(const train::LearningRates& rates);

  /// Rows whose values were set start afresh in Adam.
  void forget_moments(std::span<const std::uint32_t> rows);

  /// One step of all Gaussians that the view shows. kInvalidArgument for arrays that do not fit the view.
  Result<StepReport> step(const TrainingView& view);

  /// Rows that changed after the mark was taken: new, moved by a step or edited. Ascending. What was removed,
  /// the caller knows, having asked for it.
  [[nodiscard]] std::vector<std::uint32_t> changed_since(ChangeMark mark) const {
    return changes_.since(mark);
  }
  [[nodiscard]] ChangeMark mark() const { return changes_.mark(); }

  /// What the pictures said about each row since reset_statistics().
  [[nodiscard]] std::span<const RowStatistics> statistics() const { return statistics_; }
  void reset_statistics();
  [[nodiscard]] ExposureTable& exposures() { return exposures_; }
  /// Of differentiable pruning; not enabled() unless OptimiserOptions::prune says so.
  [[nodiscard]] const PruneSwitches& switches() const { return switches_; }
  [[nodiscard]] const OptimiserOptions& options() const { return options_; }
  /// Whether steps are taken on a GPU.
  [[nodiscard]] bool on_gpu() const { return device_ != nullptr; }
  /// Why the GPU was given up; empty while nothing failed.
  [[nodiscard]] const std::string& gpu_failure() const { return gpu_failure_; }
  /// Room for so many more rows in the budget.
  [[nodiscard]] std::size_t room() const;
  [[nodiscard]] std::uint64_t rows_refused() const { return rows_refused_; }
  /// Parameters, moments and statistics of one Gaussian.
  [[nodiscard]] std::size_t bytes_per_row() const;

 private:
  Optimiser(const OptimiserOptions& options, const Clock& clock);

  struct Pictures {
    LineVector<float> colour, depth_sum_m, alpha, seen;
    LineVector<float> by_colour, by_depth_sum, by_alpha;
  };
  void size_pictures(const TrainingView& view);
  void compare(const TrainingView& view, StepReport& report);
  /// Adds the regularisers' gradients to a block's, and returns what they cost.
  double regularise(const train::GradientBlock& block, std::size_t visible) const;
  /// Adam, and the switches where there are any; adds what these cost to `loss`.
  void step_rows(const train::GradientBlock& block, std::size_t visible, double& loss);
  /// From the splats' gradients to moved Gaussians.
  void move_rows(const splat::View& view, const train::BlendGradients& gradients, StepReport& report);
  void keep_rows(std::span<const std::uint32_t> rows);
  Result<StepReport> step_on_cpu(const TrainingView& view);
  Result<StepReport> step_on_gpu(const TrainingView& view);
  /// Takes the GPU where there is one and it is wanted.
  void open_gpu();
  /// Rows of another size: the device starts with them as new ones.
  void restart_gpu();
  void give_up_gpu(const Error& error);

  OptimiserOptions options_;
  const Clock* clock_;
  gaussian::GaussianCloud cloud_;
  train::Adam adam_;
  ExposureTable exposures_;
  PruneSwitches switches_;
  RowChanges changes_;
  std::vector<RowStatistics> statistics_;
  // Kept from step to step for their memory only.
  Pictures pictures_;
  splat::RenderScratch drawn_;
  train::BlendBackwardScratch scratch_;
  std::uint64_t rows_refused_ = 0;
  std::unique_ptr<StepDevice> device_;  ///< has Adam's moments instead of adam_
  train::GaussianGradients moved_;      ///< kept for its memory only
  std::string gpu_failure_;
};

}  // namespace edgesplat::mapping
