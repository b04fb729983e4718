// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mapping/step_device.hpp"

#include <algorithm>
#include <numeric>

namespace edgesplat::mapping {
namespace {

/// Of what is free when the optimiser is made; the rest is for whoever else uses the GPU.
constexpr double kVramShare = 0.6;

train::TrainSettings settings_of(const OptimiserOptions& options) {
  train::TrainSettings settings;
  settings.rates = options.rates;
  settings.render = options.render;
  settings.ssim_share = options.ssim_share;
  settings.depth_factor = options.depth_factor;
  settings.depth_min_alpha = options.depth_min_alpha;
  settings.gap_factor = options.gap_factor;
  settings.opacity_factor = options.opacity_factor;
  settings.scale_factor = options.scale_factor;
  return settings;
}

/// The rows of `moved` into the cloud.
void store(const train::GaussianGradients& moved, gaussian::GaussianCloud& cloud) {
  using train::ParameterRow;
  const std::size_t sh_floats = cloud.sh_floats_each();
  for (std::size_t i = 0; i < moved.rows.size(); ++i) {
    const std::size_t row = moved.rows[i];
    const float* const values = moved.row(i).data();
    std::copy_n(values + ParameterRow::kMean, 3, &cloud.means_m[3 * row]);
    std::copy_n(values + ParameterRow::kLogScale, 3, &cloud.log_scales[3 * row]);
    std::copy_n(values + ParameterRow::kQuat, 4, &cloud.quats_xyzw[4 * row]);
    cloud.opacity_logits[row] = values[ParameterRow::kOpacity];
    std::copy_n(values + ParameterRow::kSh, sh_floats, &cloud.sh[sh_floats * row]);
  }
}

class CudaSteps : public StepDevice {
 public:
  CudaSteps(core::Stream stream, std::size_t budget_bytes, const OptimiserOptions& options)
      : stream_(std::move(stream)),
        pool_(budget_bytes),
        steps_(pool_, options.adam),
        settings_(settings_of(options)) {}

  void set_rates(const train::LearningRates& rates) override { settings_.rates = rates; }

  Result<train::TrainReport> step(const TrainingView& view, const train::TrainTarget& target,
                                  gaussian::GaussianCloud& cloud, train::GaussianGradients& moved) override {
    if (changed_) {
      EDGESPLAT_TRY_STATUS(steps_.replace_cloud(stream_, splat::spans_of(cloud), from_rows_));
      std::iota(from_rows_.begin(), from_rows_.end(), 0U);
      changed_ = false;
    }
    EDGESPLAT_TRY(const train::TrainReport report, steps_.step(stream_, view.view, target, settings_));
    EDGESPLAT_TRY_STATUS(steps_.fetch_moved(stream_, moved));
    store(moved, cloud);
    return report;
  }

 private:
  core::Stream stream_;
  core::VramPool pool_;
  train::CudaTrainStep steps_;
  train::TrainSettings settings_;
};

}  // namespace

Result<std::unique_ptr<StepDevice>> open_cuda_steps(const OptimiserOptions& options) {
  EDGESPLAT_TRY(core::Stream stream, core::Stream::create());
  EDGESPLAT_TRY(const std::size_t budget_bytes, core::share_of_free_vram(kVramShare));
  return std::make_unique<CudaSteps>(std::move(stream), budget_bytes, options);
}

}  // namespace edgesplat::mapping
