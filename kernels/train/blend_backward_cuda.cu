// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/warp_sums.cuh"
#include "kernels/splat/tile_threads.cuh"
#include "kernels/train/blend_backward_math.hpp"
#include "kernels/train/device_step.cuh"

namespace edgesplat::train {
namespace {

constexpr unsigned kBatch = core::kWarp;  ///< splats at a time: one each lane to ask which reach the warp
constexpr unsigned kWarps = splat::kTileThreads / core::kWarp;

struct Batch {
  splat::BlendRecord records[kBatch];
  std::uint32_t places[kBatch];  ///< row of slot_sums or of sums
  unsigned reached[kWarps];      ///< by warp, a bit a splat
  float sums[kWarps][kBatch][kSumStride];
};

__device__ ReversePixel load_pixel(const ReverseOnDevice& reverse, const splat::TileThread& at) {
  if (!at.inside) {
    ReversePixel outside;
    outside.full = true;
    return outside;
  }
  const GradientsOfPictures& by = reverse.by_picture;
  return reverse_pixel(reverse.drawn.colour + 3 * at.pixel, reverse.drawn.depth_sum_m[at.pixel],
                       reverse.drawn.alpha[at.pixel], by.colour + 3 * at.pixel,
                       by.depth_sum == nullptr ? 0.0F : by.depth_sum[at.pixel],
                       by.alpha == nullptr ? 0.0F : by.alpha[at.pixel]);
}

/// The warp's pixels against each splat of the batch that reaches them; leaves its sums.
__device__ void reverse_batch(Batch& batch, unsigned count, const splat::TileThread& at,
                              ReversePixel& pixel) {
  const bool asks =
      at.lane < count && splat::reaches_rectangle(batch.records[at.lane], at.left_px, at.top_px,
                                                  splat::kWarpWidth_px - 1, splat::kWarpHeight_px - 1);
  unsigned reached = 0;
  for (unsigned todo = __ballot_sync(core::kAllLanes, asks ? 1 : 0); todo != 0; todo &= todo - 1) {
    const auto k = static_cast<unsigned>(__ffs(todo) - 1);
    const splat::BlendRecord& record = batch.records[k];
    float sums[16] = {};
    const bool adds = reverse_into(record, at.x_px - record.u_px, at.y_px - record.v_px, pixel, sums);
    if (__any_sync(core::kAllLanes, adds ? 1 : 0) == 0) continue;
    reached |= 1U << k;
    const float sum = core::warp_sums16(sums, at.lane);
    if (at.lane < kSumStride) batch.sums[at.warp][k][at.lane] = sum;
  }
  if (at.lane == 0) batch.reached[at.warp] = reached;
}

/// Adds up the warps, in their order, and hands on what the tile says about each splat of the batch.
template <bool kInOrder>
__device__ void hand_on(const Batch& batch, unsigned count, const ReverseOnDevice& reverse) {
  for (unsigned i = threadIdx.x; i < count * kSumStride; i += splat::kTileThreads) {
    const unsigned k = i / kSumStride, quantity = i % kSumStride;
    float sum = 0.0F;
    bool any = false;
    for (unsigned warp = 0; warp < kWarps; ++warp) {
      if ((batch.reached[warp] >> k & 1U) == 0) continue;
      sum += batch.sums[warp][k][quantity];
      any = true;
    }
    const std::size_t place = std::size_t{batch.places[k]} * kSumStride + quantity;
    if constexpr (kInOrder) {
      reverse.slot_sums[place] = sum;
    } else if (any) {
      atomicAdd(reverse.sums + place, sum);
    }
  }
}

/// A block a tile, threads as in blend_kernel.
template <bool kInOrder>
__global__ void __launch_bounds__(splat::kTileThreads) blend_backward_kernel(ReverseOnDevice reverse) {
  __shared__ Batch batch;
  const splat::FrameOnDevice& frame = reverse.frame;
  const splat::TileThread at = splat::tile_thread(frame.view);
  const std::size_t end = frame.tile_starts[blockIdx.x + 1];
  std::size_t first = frame.tile_starts[blockIdx.x];
  ReversePixel pixel = load_pixel(reverse, at);
  for (; first < end; first += kBatch) {
    // Also keeps the batch until every warp is through it.
    if (__syncthreads_and(pixel.full ? 1 : 0) != 0) break;
    const std::size_t left = end - first;
    const auto count = static_cast<unsigned>(left < kBatch ? left : kBatch);
    if (threadIdx.x < count) {
      const std::uint32_t splat = frame.pair_splats[first + threadIdx.x];
      batch.records[threadIdx.x] = splat::blend_record(frame.splats[splat]);
      batch.places[threadIdx.x] = kInOrder ? frame.pair_slots[first + threadIdx.x] : splat;
    }
    __syncthreads();
    reverse_batch(batch, count, at, pixel);
    __syncthreads();
    hand_on<kInOrder>(batch, count, reverse);
  }
  if constexpr (kInOrder) {
    // Hidden behind full pixels.
    for (std::size_t i = first * kSumStride + threadIdx.x; i < end * kSumStride; i += splat::kTileThreads)
      reverse.slot_sums[std::size_t{frame.pair_slots[i / kSumStride]} * kSumStride + i % kSumStride] = 0.0F;
  }
}

/// What all tiles say about each splat, tile by tile.
__global__ void sum_slots_kernel(ReverseOnDevice reverse) {
  const splat::FrameOnDevice& frame = reverse.frame;
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  const std::size_t j = i / kSumStride;
  if (j >= frame.room.visible || j >= frame.counts->visible) return;
  const std::size_t first = frame.slot_starts[j];
  std::size_t last = first + frame.tile_counts[j];
  if (last > frame.room.pairs) last = first < frame.room.pairs ? frame.room.pairs : first;
  float sum = 0.0F;
  for (std::size_t slot = first; slot < last; ++slot)
    sum += reverse.slot_sums[slot * kSumStride + i % kSumStride];
  reverse.sums[i] = sum;
}

}  // namespace

Status blend_backward_on_device(const core::Stream& stream, const ReverseOnDevice& reverse) {
  const splat::FrameOnDevice& frame = reverse.frame;
  const core::LaunchShape tiles{static_cast<unsigned>(frame.view.tiles()), splat::kTileThreads};
  const std::size_t floats = frame.room.visible * kSumStride;
  if (frame.keeps_slots) {
    EDGESPLAT_TRY_STATUS(core::launch(stream, tiles, blend_backward_kernel<true>, reverse));
    return core::launch(stream, core::one_thread_each(floats), sum_slots_kernel, reverse);
  }
  if (floats > 0) EDGESPLAT_CUDA_TRY(cudaMemsetAsync(reverse.sums, 0, floats * sizeof(float), stream.get()));
  return core::launch(stream, tiles, blend_backward_kernel<false>, reverse);
}

}  // namespace edgesplat::train
