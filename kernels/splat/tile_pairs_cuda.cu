// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/core/launch.cuh"
#include "kernels/splat/device_frame.cuh"
#include "kernels/splat/tile_reach.hpp"

#include <bit>

namespace edgesplat::splat {
namespace {

/// Tiles of each splat, in the order of depth; 0 beyond the visible ones.
__global__ void gather_counts_kernel(FrameOnDevice frame) {
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= frame.room.visible) return;
  frame.counts_by_depth[i] = i < frame.counts->visible ? frame.tile_counts[frame.by_depth[i]] : 0U;
}

/// Writes a pair for each tile that a splat reaches, splat by splat in the order of depth. A pair's place is
/// its slot. What finds no room is left out; FrameCounts tells.
__global__ void emit_kernel(FrameOnDevice frame) {
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= frame.room.visible || i >= frame.counts->visible) return;
  const std::uint32_t j = frame.by_depth[i];
  const Splat splat = frame.splats[j];
  std::size_t slot = frame.starts_by_depth[i];
  frame.slot_starts[j] = static_cast<std::uint32_t>(slot);
  const TileInterval rows = rows_reached(splat, frame.view.rows);
  for (int row = rows.first; row < rows.last; ++row) {
    const TileInterval columns = columns_reached(splat, row, frame.view.columns);
    for (int column = columns.first; column < columns.last && slot < frame.room.pairs; ++column, ++slot) {
      frame.pair_keys[slot] = static_cast<std::uint32_t>(row * frame.view.columns + column);
      frame.pair_values[slot] = frame.keeps_slots ? static_cast<std::uint32_t>(slot) : j;
      if (frame.keeps_slots) frame.slot_splats[slot] = j;
    }
  }
}

__global__ void splats_of_slots_kernel(FrameOnDevice frame) {
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= frame.room.pairs || frame.pair_keys_out[i] >= frame.view.tiles()) return;  // padding has no slot
  frame.pair_splats[i] = frame.slot_splats[frame.pair_slots[i]];
}

/// Where each tile's pairs begin: a thread for each place between two pairs fills the tiles that begin there.
/// Padding counts as a tile after the last.
__global__ void tile_starts_kernel(FrameOnDevice frame) {
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i > frame.room.pairs) return;
  const auto end = static_cast<std::uint32_t>(frame.view.tiles());
  const auto tile_at = [&](std::size_t pair) {
    const std::uint32_t key = pair < frame.room.pairs ? frame.pair_keys_out[pair] : end;
    return key < end ? key : end;
  };
  const std::uint32_t last = tile_at(i);
  const std::uint32_t first = i == 0 ? 0U : tile_at(i - 1) + 1U;
  for (std::uint32_t tile = first; tile <= last; ++tile)
    frame.tile_starts[tile] = static_cast<std::uint32_t>(i);
}

}  // namespace

Status make_pairs(const core::Stream& stream, const FrameOnDevice& frame, core::DeviceSort& sort) {
  if (frame.cloud.count > 0) {
    const core::LaunchShape visible = core::one_thread_each(frame.room.visible);
    EDGESPLAT_TRY_STATUS(sort.sort(
        stream,
        {frame.depth_keys, frame.depth_values, frame.depth_keys_out, frame.by_depth, frame.room.visible},
        32));
    EDGESPLAT_TRY_STATUS(core::launch(stream, visible, gather_counts_kernel, frame));
    EDGESPLAT_TRY_STATUS(
        sort.exclusive_sum(stream, frame.counts_by_depth, frame.starts_by_depth, frame.room.visible));
    EDGESPLAT_CUDA_TRY(
        cudaMemsetAsync(frame.pair_keys, 0xFF, frame.room.pairs * sizeof(std::uint32_t), stream.get()));
    EDGESPLAT_TRY_STATUS(core::launch(stream, visible, emit_kernel, frame));
    std::uint32_t* const sorted = frame.keeps_slots ? frame.pair_slots : frame.pair_splats;
    // So many bits that padding, all ones, lies behind the last tile.
    const auto bits = static_cast<int>(std::bit_width(frame.view.tiles()));
    EDGESPLAT_TRY_STATUS(sort.sort(
        stream, {frame.pair_keys, frame.pair_values, frame.pair_keys_out, sorted, frame.room.pairs}, bits));
    if (frame.keeps_slots) {
      EDGESPLAT_TRY_STATUS(
          core::launch(stream, core::one_thread_each(frame.room.pairs), splats_of_slots_kernel, frame));
    }
  }
  return core::launch(stream, core::one_thread_each(frame.room.pairs + 1), tile_starts_kernel, frame);
}

}  // namespace edgesplat::splat
