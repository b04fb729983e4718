// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "kernels/mapping/exposure.hpp"
#include "kernels/mapping/prune_switches.hpp"
#include "kernels/splat/view.hpp"
#include "kernels/train/adam.hpp"

#include <cstddef>

namespace edgesplat::mapping {

/// The defaults are for metric scenes that LiDAR seeded, the size of rooms and streets: means start within
/// centimetres of the surface, so they need millimetres a step, not the 1e-3 of the scene's extent of a
/// structure-from-motion start.
struct OptimiserOptions {
  int sh_degree = 0;  ///< 0..3; rows of a lower degree are padded
  /// mean_m 2e-5..5e-3 (rooms 2e-4, streets 1e-3), log_scale 1e-3..2e-2, quat 1e-4..1e-2, opacity_logit
  /// 5e-3..0.1, sh_base 1e-3..2e-2, sh_rest a twentieth of that
  train::LearningRates rates;
  train::AdamOptions adam;
  ExposureOptions exposure;
  splat::RenderOptions render;
  float ssim_share = 0.2F;       ///< of the colour loss, 0..1; 0 saves a third of the time
  float depth_factor = 0.1F;     ///< of the depth loss in metres beside the colour loss, 0 (off)..1
  float depth_min_alpha = 0.5F;  ///< pixels covered less say nothing about depth, 0.05..1
  /// Of the mean transparency of the pixels that count: a world without gaps, so that Gaussians do not grow
  /// too bright for the black behind them, 0..1
  float gap_factor = 0.0F;
  float opacity_factor = 0.0F;  ///< of the mean opacity of what a picture shows: thins the map out, 0..0.1
  float scale_factor = 0.0F;    ///< of the mean scale (m) of what a picture shows, 0..0.1
  PruneOptions prune;           ///< differentiable pruning; with it steps are the CPU's alone
  bool on_gpu = true;           ///< where there is one
  std::size_t max_gaussians = 2'000'000;          ///< 1..2^31
  std::size_t max_bytes = std::size_t{4} << 30U;  ///< of parameters, moments and statistics

  /// kInvalidConfig with the field's name where a value lies outside its range.
  [[nodiscard]] Status validate() const;
};

}  // namespace edgesplat::mapping
