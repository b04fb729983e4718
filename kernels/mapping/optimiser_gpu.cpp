// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The optimiser's steps on a GPU.
#include "kernels/core/backend.hpp"
#include "kernels/mapping/optimiser.hpp"
#include "kernels/mapping/step_device.hpp"

#include <algorithm>

namespace edgesplat::mapping {

Optimiser::~Optimiser() = default;
Optimiser::Optimiser(Optimiser&&) noexcept = default;
Optimiser& Optimiser::operator=(Optimiser&&) noexcept = default;

void Optimiser::open_gpu() {
#ifdef EDGESPLAT_WITH_CUDA
  const auto fastest = core::choose_backend("auto");
  if (options_.on_gpu && !switches_.enabled() && fastest && *fastest == core::Backend::kCuda) {
    auto device = open_cuda_steps(options_);
    if (device) {
      device_ = std::move(*device);
    } else {
      gpu_failure_ = device.error().context;
    }
  }
#endif
}

Result<StepReport> Optimiser::step_on_gpu(const TrainingView& view) {
  const HostTime began = clock_->now();
  train::TrainTarget target{view.colour, view.depth_m, view.weight, {}};
  if (view.exposure_key) {
    const Exposure exposure = exposures_.of(*view.exposure_key);
    target.exposure.emplace();
    std::copy_n(exposure.gain.begin(), 3, target.exposure->begin());
    std::copy_n(exposure.offset.begin(), 3, target.exposure->begin() + 3);
  }
  EDGESPLAT_TRY(const train::TrainReport done, device_->step(view, target, cloud_, moved_));
  if (view.exposure_key) exposures_.learn(*view.exposure_key, done.by_exposure);
  changes_.begin();
  for (std::size_t i = 0; i < moved_.rows.size(); ++i) {
    changes_.touch(moved_.rows[i]);
    add_sighting(moved_.sightings[i], 0.5F * static_cast<float>(view.view.width_px),
                 statistics_[moved_.rows[i]]);
  }
  StepReport report;
  report.loss = done.loss;
  report.l1 = done.l1;
  report.depth_m = done.depth_m;
  report.visible = done.visible;
  report.by_pose = done.by_pose;
  report.times.update = clock_->now() - began;  // one run on the device: its parts are not told apart
  return report;
}

void Optimiser::set_rates(const train::LearningRates& rates) {
  options_.rates = rates;
  if (device_) device_->set_rates(rates);
}

void Optimiser::restart_gpu() {
  device_.reset();
  open_gpu();
  if (device_) {
    device_->appended(cloud_.size());
  } else {
    adam_.resize(cloud_.size());
  }
}

void Optimiser::give_up_gpu(const Error& error) {
  gpu_failure_ = error.context;
  device_.reset();
  adam_.resize(cloud_.size());
}

}  // namespace edgesplat::mapping
