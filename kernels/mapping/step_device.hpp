// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/mapping/optimiser_options.hpp"
#include "kernels/mapping/training_view.hpp"
#include "kernels/train/cuda_train_step.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace edgesplat::mapping {

/// Takes the optimiser's steps on a GPU. The optimiser keeps the Gaussians: their values go there when it
/// changed rows itself and come back, those that moved, after every step. The moments of Adam are here alone.
/// Single-owner.
class StepDevice {
 public:
  virtual ~StepDevice() = default;

  /// So many rows were appended.
  void appended(std::size_t rows) {
    from_rows_.insert(from_rows_.end(), rows, train::CudaTrainStep::kFreshRow);
    changed_ = true;
  }
  /// These, ascending, were kept of those there were.
  void kept(std::span<const std::uint32_t> rows) {
    for (std::size_t to = 0; to < rows.size(); ++to) from_rows_[to] = from_rows_[rows[to]];
    from_rows_.resize(rows.size());
    changed_ = true;
  }
  /// Values of rows were set.
  void edited() { changed_ = true; }
  /// This row's moments are to be forgotten.
  void forget(std::uint32_t row) {
    from_rows_[row] = train::CudaTrainStep::kFreshRow;
    changed_ = true;
  }

  /// From the next step on.
  virtual void set_rates(const train::LearningRates& rates) = 0;
  /// One step; `cloud` gets the new values of the rows in `moved`, which also tells how the picture saw them
  /// (its values are the parameters). kOutOfVram or what the device says: then nothing in `cloud` moved.
  [[nodiscard]] virtual Result<train::TrainReport> step(const TrainingView& view,
                                                        const train::TrainTarget& target,
                                                        gaussian::GaussianCloud& cloud,
                                                        train::GaussianGradients& moved) = 0;

 protected:
  std::vector<std::uint32_t> from_rows_;  ///< [N] where each row's moments lie on the device, or kFreshRow
  bool changed_ = false;                  ///< since the device got the rows
};

/// kUnavailable where there is no GPU; builds with CUDA only.
[[nodiscard]] Result<std::unique_ptr<StepDevice>> open_cuda_steps(const OptimiserOptions& options);

}  // namespace edgesplat::mapping
