// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/launch.cuh"
#include "kernels/splat/device_frame.cuh"

namespace edgesplat::splat {

/// How the threads of a block share the 16x16 pixels of a tile: a warp has 8x4 of them, so that a small splat
/// concerns few warps.
inline constexpr unsigned kTileThreads = 256;
inline constexpr int kWarpWidth_px = 8;
inline constexpr int kWarpHeight_px = 4;

struct TileThread {
  unsigned warp, lane;
  float x_px, y_px;       ///< the thread's pixel
  float left_px, top_px;  ///< the first pixel of its warp
  bool inside;            ///< whether the picture has it
  std::size_t pixel;      ///< its place in the picture, where it has
};

/// Block b has tile b, row by row.
__device__ inline TileThread tile_thread(const DeviceView& view) {
  TileThread at;
  at.warp = threadIdx.x / core::kWarp;
  at.lane = threadIdx.x % core::kWarp;
  const int column = static_cast<int>(blockIdx.x) % view.columns;
  const int row = static_cast<int>(blockIdx.x) / view.columns;
  const int left = 16 * column + kWarpWidth_px * static_cast<int>(at.warp % 2);
  const int top = 16 * row + kWarpHeight_px * static_cast<int>(at.warp / 2);
  const int x = left + static_cast<int>(at.lane) % kWarpWidth_px;
  const int y = top + static_cast<int>(at.lane) / kWarpWidth_px;
  at.x_px = static_cast<float>(x);
  at.y_px = static_cast<float>(y);
  at.left_px = static_cast<float>(left);
  at.top_px = static_cast<float>(top);
  at.inside = x < view.width_px && y < view.height_px;
  at.pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width_px) + static_cast<std::size_t>(x);
  return at;
}

}  // namespace edgesplat::splat
