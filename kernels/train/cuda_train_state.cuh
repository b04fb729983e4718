// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/forward_pass.cuh"
#include "kernels/train/cuda_train_step.hpp"
#include "kernels/train/device_losses.cuh"
#include "kernels/train/device_step.cuh"

namespace edgesplat::train {

/// Everything that a CudaTrainStep has on the device.
struct CudaTrainStep::State {
  State(core::VramPool& pool, const AdamOptions& options, bool in_order);

  /// Buffers for pictures of this size, as far as they are needed, and what points to them.
  [[nodiscard]] Status size_pictures(const splat::DeviceView& view, const TrainTarget& target,
                                     const TrainSettings& settings);
  /// The same for what goes back, once the frame's room is known.
  [[nodiscard]] Status size_reverse();
  [[nodiscard]] Status upload_target(const core::Stream& stream, const TrainTarget& target);
  /// Forward, losses, backward and Adam into the stream.
  [[nodiscard]] Status start(const core::Stream& stream, const splat::DeviceView& view,
                             const TrainSettings& settings);
  /// From dL by the pictures to the Gaussians and the pose.
  [[nodiscard]] Status start_reverse(const core::Stream& stream);
  /// Row i of the moments and steps becomes row from_rows[i] of those there are, see replace_cloud().
  [[nodiscard]] Status move_moments(const core::Stream& stream, std::span<const std::uint32_t> from_rows,
                                    std::size_t stride);
  [[nodiscard]] AdamOnDevice adam_of(const TrainSettings& settings);

  splat::DeviceCloud cloud;
  splat::ForwardPass pass;
  core::DeviceBuffer<float> pictures;  ///< colour, depth and alpha as drawn and as seen, gradients, slopes
  core::DeviceBuffer<float> target_colour, target_depth_m, target_weight;
  core::DeviceBuffer<float> slot_sums, sums, rows;
  core::DeviceBuffer<Sighting> sightings;
  core::DeviceBuffer<double> parts, scalars;
  core::DeviceBuffer<std::uint32_t> splat_of_row, shown;
  core::DeviceBuffer<float> first, second;
  core::DeviceBuffer<std::uint32_t> moving, steps, from_rows;
  LossOnDevice loss{};
  ReverseOnDevice reverse{};
  AdamDecay decay;
  std::size_t visible = 0;  ///< splats of the frame that `reverse` is of
};

}  // namespace edgesplat::train
