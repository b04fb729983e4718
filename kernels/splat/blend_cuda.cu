// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/launch.cuh"
#include "kernels/splat/blend_math.hpp"
#include "kernels/splat/device_frame.cuh"
#include "kernels/splat/tile_threads.cuh"

namespace edgesplat::splat {
namespace {

__device__ void write_pixel(const FrameOnDevice& frame, const TileThread& at, const BlendPixel& pixel,
                            const DevicePictures& out) {
  if (!at.inside) return;
  for (int c = 0; c < 3; ++c) {
    out.colour[3 * at.pixel + static_cast<std::size_t>(c)] =
        pixel.rgb[c] + pixel.transmittance * frame.view.background[c];
  }
  out.depth_sum_m[at.pixel] = pixel.depth_m;
  out.alpha[at.pixel] = 1.0F - pixel.transmittance;
}

/// A block a tile, a thread a pixel, a warp 8x4 of them. Splats come to the block's memory 256 at a time;
/// each warp asks 32 of them at once which reach its pixels and blends only those, until all its pixels are
/// full.
__global__ void __launch_bounds__(kTileThreads) blend_kernel(FrameOnDevice frame, DevicePictures out) {
  __shared__ BlendRecord batch[kTileThreads];
  const TileThread at = tile_thread(frame.view);
  const std::size_t end = frame.tile_starts[blockIdx.x + 1];
  BlendPixel pixel;
  pixel.full = !at.inside;
  for (std::size_t first = frame.tile_starts[blockIdx.x]; first < end; first += kTileThreads) {
    // Also keeps the batch until every warp is through it.
    if (__syncthreads_and(pixel.full ? 1 : 0) != 0) break;
    const std::size_t mine = first + threadIdx.x;
    if (mine < end) batch[threadIdx.x] = blend_record(frame.splats[frame.pair_splats[mine]]);
    __syncthreads();
    const std::size_t left = end - first;
    const auto count = static_cast<unsigned>(left < kTileThreads ? left : kTileThreads);
    for (unsigned group = 0; group < count; group += core::kWarp) {
      if (__all_sync(core::kAllLanes, pixel.full ? 1 : 0) != 0) break;
      const unsigned asked = group + at.lane;
      const bool reached = asked < count && reaches_rectangle(batch[asked], at.left_px, at.top_px,
                                                              kWarpWidth_px - 1, kWarpHeight_px - 1);
      for (unsigned todo = __ballot_sync(core::kAllLanes, reached ? 1 : 0); todo != 0; todo &= todo - 1) {
        const BlendRecord& splat = batch[group + static_cast<unsigned>(__ffs(todo) - 1)];
        blend_into(splat, at.x_px - splat.u_px, at.y_px - splat.v_px, pixel);
      }
    }
  }
  write_pixel(frame, at, pixel, out);
}

}  // namespace

Status blend_on_device(const core::Stream& stream, const FrameOnDevice& frame, const DevicePictures& out) {
  return core::launch(stream, {static_cast<unsigned>(frame.view.tiles()), kTileThreads}, blend_kernel, frame,
                      out);
}

}  // namespace edgesplat::splat
