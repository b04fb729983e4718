// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/backend.hpp"
#include "kernels/train/adam.hpp"
#include "kernels/train/gaussian_backward.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace edgesplat::train {

/// A way to go back and to step: a backend, on CUDA with sums in a fixed order or as they come.
struct Way {
  core::Backend backend;
  bool in_order = true;
  [[nodiscard]] std::string name() const {
    return std::string(core::to_string(backend)) + (in_order ? "" : "_unordered");
  }
};

/// What a picture is compared with, and how (as TrainTarget and TrainSettings, which only CUDA has).
struct Task {
  std::vector<float> colour, depth_m, weight;
  std::optional<std::array<float, 6>> exposure;
  LearningRates rates;
  AdamOptions adam;
  splat::RenderOptions render;
  float ssim_share = 0.2F, depth_factor = 0.1F, depth_min_alpha = 0.5F, gap_factor = 0.0F;
  float opacity_factor = 0.0F, scale_factor = 0.0F;
};

struct StepResult {
  double loss = 0.0, l1 = 0.0, ssim = 0.0, depth_m = 0.0;
  std::size_t visible = 0;
  std::array<double, 6> by_pose{}, by_exposure{};
};

/// Draws, and goes back from dL by the pictures.
[[nodiscard]] Result<GaussianGradients> gradients_on(const Way& way, const gaussian::GaussianCloud& cloud,
                                                     const splat::View& view,
                                                     const splat::RenderOptions& options,
                                                     const PictureGradients& by_picture);

/// `steps` whole steps of `cloud`; what they say, one after the other.
[[nodiscard]] Result<std::vector<StepResult>> steps_on(const Way& way, const splat::View& view,
                                                       const Task& task, int steps,
                                                       gaussian::GaussianCloud& cloud);

}  // namespace edgesplat::train
