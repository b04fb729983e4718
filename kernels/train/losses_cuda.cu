// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/warp_sums.cuh"
#include "kernels/train/device_losses.cuh"
#include "kernels/train/device_step.cuh"

#include <algorithm>

namespace edgesplat::train {
namespace {

constexpr unsigned kThreads = 256;

__device__ float weight_of(const LossOnDevice& loss, std::size_t pixel) {
  return loss.weight == nullptr ? 1.0F : loss.weight[pixel];
}

/// A pixel that has a measurement and enough coverage.
__device__ bool is_measured(const LossOnDevice& loss, std::size_t pixel) {
  if (loss.target_m == nullptr) return false;
  const float target = loss.target_m[pixel];
  return target > 0.0F && target - target == 0.0F && loss.drawn.alpha[pixel] >= loss.factors.depth_min_alpha;
}

/// Leaves a block's sums of kCount values of every thread.
template <unsigned kCount>
__device__ void leave_parts(const float* values, double* parts) {
  for (unsigned k = 0; k < kCount; ++k) {
    const double sum = core::block_sum<kThreads>(static_cast<double>(values[k]));
    if (threadIdx.x == 0) parts[std::size_t{blockIdx.x} * kCount + k] = sum;
  }
}

__global__ void __launch_bounds__(kThreads) totals_kernel(LossOnDevice loss) {
  const std::size_t i = std::size_t{blockIdx.x} * kThreads + threadIdx.x;
  float values[2] = {0.0F, 0.0F};
  if (i < loss.pixels()) {
    values[0] = weight_of(loss, i);
    values[1] = is_measured(loss, i) ? values[0] : 0.0F;
  }
  leave_parts<2>(values, loss.parts);
}

__device__ float sign_of(float value) {
  return value > 0.0F ? 1.0F : (value < 0.0F ? -1.0F : 0.0F);
}

/// 1 / total as a factor; 0 where nothing counts.
__device__ float share_of(double factor, double total) {
  return total > 0.0 ? static_cast<float>(factor / total) : 0.0F;
}

__device__ float l1_of_pixel(const LossOnDevice& loss, std::size_t i) {
  const float w = weight_of(loss, i);
  const auto l1_share = static_cast<double>(1.0F - loss.factors.ssim_share);
  const float scale = share_of(l1_share, 3.0 * loss.scalars[kTotalWeight]);
  float apart = 0.0F;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::size_t at = 3 * i + c;
    if (loss.exposed) loss.seen[at] = loss.gain[c] * loss.drawn.colour[at] + loss.offset[c];
    const float d = loss.seen[at] - loss.target[at];
    apart += d < 0.0F ? -d : d;
    loss.by_colour[at] = scale * w * sign_of(d);
  }
  return w * apart;
}

__device__ float depth_of_pixel(const LossOnDevice& loss, std::size_t i, float& by_alpha) {
  if (!is_measured(loss, i)) {
    if (loss.by_depth_sum != nullptr) loss.by_depth_sum[i] = 0.0F;
    return 0.0F;
  }
  const float w = weight_of(loss, i);
  const float alpha = loss.drawn.alpha[i];
  const float depth_m = loss.drawn.depth_sum_m[i] / alpha;
  const float d = depth_m - loss.target_m[i];
  const float scale = share_of(static_cast<double>(loss.factors.depth_factor), loss.scalars[kMeasuredWeight]);
  const float by_depth = scale * w * sign_of(d);
  loss.by_depth_sum[i] = by_depth / alpha;
  by_alpha -= by_depth * depth_m / alpha;
  return w * (d < 0.0F ? -d : d);
}

/// All that needs no neighbours.
__global__ void __launch_bounds__(kThreads) pixels_kernel(LossOnDevice loss) {
  const std::size_t i = std::size_t{blockIdx.x} * kThreads + threadIdx.x;
  float values[3] = {0.0F, 0.0F, 0.0F};
  if (i < loss.pixels()) {
    float by_alpha = 0.0F;
    values[0] = l1_of_pixel(loss, i);
    values[1] = depth_of_pixel(loss, i, by_alpha);
    if (loss.factors.gap_factor > 0.0F) {
      const float w = weight_of(loss, i);
      by_alpha -= share_of(static_cast<double>(loss.factors.gap_factor), loss.scalars[kTotalWeight]) * w;
      values[2] = w * (1.0F - loss.drawn.alpha[i]);
    }
    if (loss.by_alpha != nullptr) loss.by_alpha[i] = by_alpha;
  }
  leave_parts<3>(values, loss.parts);
}

/// From dL by the seen picture to dL by the drawn one and by the exposure.
__global__ void __launch_bounds__(kThreads) exposure_kernel(LossOnDevice loss) {
  const std::size_t i = std::size_t{blockIdx.x} * kThreads + threadIdx.x;
  float values[6] = {};
  if (i < loss.pixels()) {
    for (unsigned c = 0; c < 3; ++c) {
      float& by = loss.by_colour[3 * i + c];
      values[c] = by * loss.drawn.colour[3 * i + c];
      values[3 + c] = by;
      by *= loss.gain[c];
    }
  }
  leave_parts<6>(values, loss.parts);
}

}  // namespace

std::size_t loss_parts(int width_px, int height_px) {
  const auto pixels = static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  // One block of 16x16 pixels may be mostly beyond the edge.
  const auto tiles =
      static_cast<std::size_t>((width_px + 15) / 16) * static_cast<std::size_t>((height_px + 15) / 16);
  return std::max(6 * ((pixels + kThreads - 1) / kThreads), tiles);
}

Status compare_on_device(const core::Stream& stream, const LossOnDevice& loss) {
  const core::LaunchShape pixels = core::one_thread_each(loss.pixels(), kThreads);
  EDGESPLAT_CUDA_TRY(cudaMemsetAsync(loss.scalars, 0, kStepScalars * sizeof(double), stream.get()));
  EDGESPLAT_TRY_STATUS(core::launch(stream, pixels, totals_kernel, loss));
  EDGESPLAT_TRY_STATUS(sum_parts(stream, loss.parts, pixels.blocks, 2, loss.scalars + kTotalWeight));
  EDGESPLAT_TRY_STATUS(core::launch(stream, pixels, pixels_kernel, loss));
  EDGESPLAT_TRY_STATUS(sum_parts(stream, loss.parts, pixels.blocks, 3, loss.scalars + kL1Sum));
  if (loss.factors.ssim_share > 0.0F) EDGESPLAT_TRY_STATUS(ssim_on_device(stream, loss));
  if (!loss.exposed) return {};
  EDGESPLAT_TRY_STATUS(core::launch(stream, pixels, exposure_kernel, loss));
  return sum_parts(stream, loss.parts, pixels.blocks, 6, loss.scalars + kByExposure);
}

}  // namespace edgesplat::train
