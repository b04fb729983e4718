// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/device_frame.cuh"

#include <cstddef>

namespace edgesplat::train {

/// Scalars of a training step that the device leaves, one f64 each.
enum StepScalar {
  kTotalWeight,     ///< sum of the pixels' weights
  kMeasuredWeight,  ///< the same of the pixels whose depth counts
  kL1Sum,
  kDepthSum_m,
  kGapSum,
  kSsimSum,
  kByExposure,  ///< dL by gain and offset of the channels: 6
  kByPose = kByExposure + 6,
  kRegular = kByPose + 6,  ///< what the regularisers add to the loss
  kStepScalars
};

/// How a picture and its depth are compared with what they should be: losses.hpp, all of it in one go.
struct LossFactors {
  float ssim_share;
  float depth_factor, depth_min_alpha;
  float gap_factor;
};

struct LossOnDevice {
  int width_px, height_px;
  splat::DevicePictures drawn;
  const float* target;    // [H,W,3] f32
  const float* weight;    // [H,W] f32 or nullptr: 1
  const float* target_m;  // [H,W] f32 or nullptr: no depth
  float* seen;  // [H,W,3] f32: drawn as the camera's exposure would show it; drawn.colour without one
  bool exposed;
  float gain[3], offset[3];
  LossFactors factors;
  float* by_colour;     // [H,W,3] f32, dL by the drawn picture
  float* by_depth_sum;  // [H,W] f32 or nullptr where there is no depth
  float* by_alpha;      // [H,W] f32 or nullptr where there is neither depth nor gap loss
  float* slopes;        // [3,3,H,W] f32, of the similarity: by moment, channel
  double* parts;        // [loss_parts()] f64
  double* scalars;      // [kStepScalars] f64

  [[nodiscard]] EDGESPLAT_HOST_DEVICE std::size_t pixels() const {
    return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  }
};

[[nodiscard]] std::size_t loss_parts(int width_px, int height_px);
/// Writes by_colour, by_depth_sum and by_alpha whole, and the scalars up to kByExposure + 5. Deterministic.
[[nodiscard]] Status compare_on_device(const core::Stream& stream, const LossOnDevice& loss);
/// SSIM's part of it: adds to by_colour what (1 - SSIM) times its share does, and sums the similarity.
[[nodiscard]] Status ssim_on_device(const core::Stream& stream, const LossOnDevice& loss);

}  // namespace edgesplat::train
