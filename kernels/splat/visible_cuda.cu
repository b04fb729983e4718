// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/launch.cuh"
#include "kernels/splat/device_frame.cuh"
#include "kernels/splat/device_input.cuh"
#include "kernels/splat/tile_reach.hpp"

namespace edgesplat::splat {
namespace {

constexpr unsigned kThreads = 256;
constexpr unsigned kWarps = kThreads / core::kWarp;

/// Both kernels below must decide alike: this is where.
__device__ bool shape_in(const FrameOnDevice& frame, const SplatInput& in, Splat& splat) {
  const DeviceView& view = frame.view;
  return shape_of(in, view.camera, view.near_m, view.low_pass_px2, static_cast<float>(view.width_px),
                  static_cast<float>(view.height_px), splat);
}

/// Marks the Gaussians that the picture shows. Most are told by their depth alone.
template <bool kHalf>
__global__ void cull_kernel(FrameOnDevice frame) {
  __shared__ unsigned in_warp[kWarps];
  const std::size_t i = std::size_t{blockIdx.x} * kThreads + threadIdx.x;
  const unsigned lane = threadIdx.x % core::kWarp;
  bool visible = false;
  if (i < frame.cloud.count && (frame.cloud.finite[i / core::kWarp] >> lane & 1U) != 0) {
    InputRoom room;
    const SplatInput in = input_of<kHalf>(frame.cloud, i, false, room);
    Splat splat;
    visible = shape_in(frame, in, splat);
  }
  const unsigned word = __ballot_sync(core::kAllLanes, visible);
  if (lane == 0) {
    in_warp[threadIdx.x / core::kWarp] = static_cast<unsigned>(__popc(word));
    if (i < frame.cloud.count) frame.visible_words[i / core::kWarp] = word;
  }
  __syncthreads();
  if (threadIdx.x != 0) return;
  unsigned in_block = 0;
  for (const unsigned count : in_warp) in_block += count;
  frame.block_counts[blockIdx.x] = in_block;
}

/// Lists the rows that are marked, ascending.
__global__ void list_kernel(FrameOnDevice frame) {
  __shared__ unsigned words[kWarps];
  const std::size_t i = std::size_t{blockIdx.x} * kThreads + threadIdx.x;
  const std::size_t first_word = std::size_t{blockIdx.x} * kWarps;
  const std::size_t all_words = (frame.cloud.count + core::kWarp - 1) / core::kWarp;
  if (threadIdx.x < kWarps) {
    const std::size_t word = first_word + threadIdx.x;
    words[threadIdx.x] = word < all_words ? frame.visible_words[word] : 0U;
  }
  __syncthreads();
  const unsigned warp = threadIdx.x / core::kWarp, lane = threadIdx.x % core::kWarp;
  std::size_t place = frame.block_starts[blockIdx.x];
  for (unsigned w = 0; w < warp; ++w) place += static_cast<unsigned>(__popc(words[w]));
  const unsigned before = words[warp] & ((1U << lane) - 1U);
  place += static_cast<unsigned>(__popc(before));
  const bool visible = (words[warp] >> lane & 1U) != 0;
  if (visible && place < frame.room.visible) frame.visible_rows[place] = static_cast<std::uint32_t>(i);
  // The last thread of all knows the total.
  if (blockIdx.x + 1 == gridDim.x && threadIdx.x + 1 == kThreads) {
    frame.counts->visible = static_cast<std::uint32_t>(place + (visible ? 1U : 0U));
    frame.counts->not_finite = *frame.cloud.not_finite;
  }
}

/// The splats of the listed rows, how deep they lie and how many tiles they reach.
template <bool kHalf>
__global__ void project_kernel(FrameOnDevice frame) {
  const std::size_t j = std::size_t{blockIdx.x} * kThreads + threadIdx.x;
  unsigned long long tiles = 0;
  if (j < frame.room.visible && j < frame.counts->visible) {
    const std::uint32_t row = frame.visible_rows[j];
    InputRoom room;
    const SplatInput in = input_of<kHalf>(frame.cloud, row, true, room);
    Splat splat{};
    shape_in(frame, in, splat);
    splat.gaussian = row;
    splat.order = static_cast<std::uint32_t>(j);
    colour_towards(in, frame.view.position_m, splat.rgb);
    tiles = tiles_reached(splat, frame.view.columns, frame.view.rows);
    frame.splats[j] = splat;
    frame.depth_keys[j] = __float_as_uint(splat.depth_m);  // positive floats sort as their bits do
    frame.depth_values[j] = static_cast<std::uint32_t>(j);
    frame.tile_counts[j] = static_cast<std::uint32_t>(tiles);
  }
  for (unsigned step = core::kWarp / 2; step > 0; step /= 2)
    tiles += __shfl_xor_sync(core::kAllLanes, tiles, step);
  if (threadIdx.x % core::kWarp == 0 && tiles > 0) atomicAdd(&frame.counts->pairs, tiles);
}

}  // namespace

DeviceView device_view(const View& view, const RenderOptions& options) {
  DeviceView out{};
  out.camera = camera_of(view, options);
  for (std::size_t i = 0; i < 3; ++i) {
    out.position_m[i] = view.position[i];
    out.background[i] = options.background[i];
  }
  out.near_m = options.near_m;
  out.low_pass_px2 = options.low_pass_px2;
  out.width_px = view.width_px;
  out.height_px = view.height_px;
  out.columns = (view.width_px + kReachTilePx - 1) / kReachTilePx;
  out.rows = (view.height_px + kReachTilePx - 1) / kReachTilePx;
  return out;
}

Status find_visible(const core::Stream& stream, const FrameOnDevice& frame, core::DeviceSort& sort) {
  EDGESPLAT_CUDA_TRY(cudaMemsetAsync(frame.counts, 0, sizeof(FrameCounts), stream.get()));
  const core::LaunchShape all = core::one_thread_each(frame.cloud.count, kThreads);
  if (all.blocks == 0) return {};
  const bool half = frame.cloud.shape_halves != nullptr;
  EDGESPLAT_TRY_STATUS(core::launch(stream, all, half ? &cull_kernel<true> : &cull_kernel<false>, frame));
  EDGESPLAT_TRY_STATUS(sort.exclusive_sum(stream, frame.block_counts, frame.block_starts, all.blocks));
  EDGESPLAT_TRY_STATUS(core::launch(stream, all, list_kernel, frame));
  EDGESPLAT_CUDA_TRY(
      cudaMemsetAsync(frame.depth_keys, 0xFF, frame.room.visible * sizeof(std::uint32_t), stream.get()));
  return core::launch(stream, core::one_thread_each(frame.room.visible, kThreads),
                      half ? &project_kernel<true> : &project_kernel<false>, frame);
}

}  // namespace edgesplat::splat
