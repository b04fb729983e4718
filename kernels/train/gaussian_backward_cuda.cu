// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/warp_sums.cuh"
#include "kernels/train/blend_backward_math.hpp"
#include "kernels/train/device_step.cuh"
#include "kernels/train/gaussian_backward_math.hpp"

namespace edgesplat::train {
namespace {

constexpr unsigned kThreads = 256;

/// A thread a splat. Rows that no pixel shows keep their weight 0 and nothing else.
__global__ void __launch_bounds__(kThreads) gaussian_backward_kernel(ReverseOnDevice reverse) {
  const splat::FrameOnDevice& frame = reverse.frame;
  const std::size_t j = std::size_t{blockIdx.x} * kThreads + threadIdx.x;
  float pose[6] = {};
  bool shown = false;
  if (j < frame.room.visible && j < frame.counts->visible) {
    const float* const sums = reverse.sums + j * kSumStride;
    const splat::Splat s = frame.splats[j];
    shown = sums[kSumWeight] > 0.0F;
    Sighting sighting{0.0F, 0.0F, 0.0F};
    if (shown) {
      const SplatGradient<float> by = splat_gradient(s, sums);
      const splat::CloudOnDevice& cloud = frame.cloud;
      const std::size_t row = s.gaussian;
      const auto sh_floats = static_cast<std::size_t>(3 * (cloud.sh_degree + 1) * (cloud.sh_degree + 1));
      const splat::SplatInput in{cloud.means_m + 3 * row,    cloud.log_scales + 3 * row,
                                 cloud.quats_xyzw + 4 * row, cloud.opacity_logits[row],
                                 cloud.sh + sh_floats * row, cloud.sh_degree};
      gaussian_backward_one(in, frame.view.camera, frame.view.position_m, s, by, frame.view.low_pass_px2,
                            reverse.rows + j * reverse.stride, pose);
      sighting = {std::sqrt(by.u * by.u + by.v * by.v), sums[kSumWeight],
                  s.half_width_px > s.half_height_px ? s.half_width_px : s.half_height_px};
      reverse.splat_of_row[row] = static_cast<std::uint32_t>(j);
    }
    reverse.sightings[j] = sighting;
  }
  const unsigned in_warp = __ballot_sync(core::kAllLanes, shown ? 1 : 0);
  if (threadIdx.x % core::kWarp == 0 && in_warp != 0)
    atomicAdd(reverse.shown, static_cast<std::uint32_t>(__popc(in_warp)));
  for (unsigned k = 0; k < 6; ++k) {
    const double sum = core::block_sum<kThreads>(static_cast<double>(pose[k]));
    if (threadIdx.x == 0) reverse.pose_parts[std::size_t{blockIdx.x} * 6 + k] = sum;
  }
}

/// A block a column.
__global__ void __launch_bounds__(kThreads)
    sum_parts_kernel(const double* parts, std::size_t rows, unsigned columns, double* sums) {
  double sum = 0.0;
  for (std::size_t row = threadIdx.x; row < rows; row += kThreads) sum += parts[row * columns + blockIdx.x];
  sum = core::block_sum<kThreads>(sum);
  if (threadIdx.x == 0) sums[blockIdx.x] = sum;
}

}  // namespace

std::size_t pose_parts_of(std::size_t visible) {
  return (visible + kThreads - 1) / kThreads;
}

Status gaussian_backward_on_device(const core::Stream& stream, const ReverseOnDevice& reverse) {
  const splat::FrameOnDevice& frame = reverse.frame;
  EDGESPLAT_CUDA_TRY(cudaMemsetAsync(reverse.shown, 0, sizeof(std::uint32_t), stream.get()));
  if (frame.cloud.count > 0) {
    EDGESPLAT_CUDA_TRY(
        cudaMemsetAsync(reverse.splat_of_row, 0xFF, frame.cloud.count * sizeof(std::uint32_t), stream.get()));
  }
  return core::launch(stream, core::one_thread_each(frame.room.visible, kThreads), gaussian_backward_kernel,
                      reverse);
}

Status sum_parts(const core::Stream& stream, const double* parts, std::size_t rows, unsigned columns,
                 double* sums) {
  return core::launch(stream, {columns, kThreads}, sum_parts_kernel, parts, rows, columns, sums);
}

}  // namespace edgesplat::train
