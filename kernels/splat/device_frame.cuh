// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/core/device_sort.cuh"
#include "kernels/core/stream.hpp"
#include "kernels/splat/device_cloud.cuh"
#include "kernels/splat/project.hpp"
#include "kernels/splat/project_math.hpp"
#include "kernels/splat/view.hpp"

#include <cstddef>
#include <cstdint>

namespace edgesplat::splat {

/// The view as kernels see it.
struct DeviceView {
  CameraT<float> camera;
  float position_m[3];
  float near_m, low_pass_px2;
  float background[3];
  int width_px, height_px;
  int columns, rows;  ///< of tiles

  [[nodiscard]] EDGESPLAT_HOST_DEVICE std::size_t pixels() const {
    return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  }
  [[nodiscard]] EDGESPLAT_HOST_DEVICE std::size_t tiles() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
};
[[nodiscard]] DeviceView device_view(const View& view, const RenderOptions& options);

/// What a frame turned out to need, counted on the device. Where it is more than the frame's room, the
/// picture is not complete and must be drawn again with more.
struct FrameCounts {
  unsigned long long pairs;
  std::uint32_t visible;
  std::uint32_t not_finite;
};

/// How much of its buffers a frame uses: kernels and sorts run over this much.
struct FrameRoom {
  std::size_t visible = 0;
  std::size_t pairs = 0;
};

/// One frame's arrays on the device, as kernels see them. V = room.visible, P = room.pairs; what lies beyond
/// the counts of the frame is padding.
struct FrameOnDevice {
  CloudOnDevice cloud;
  DeviceView view;
  FrameRoom room;
  FrameCounts* counts;             // [1]
  std::uint32_t* visible_words;    // [ceil(N/32)] u32, a bit a Gaussian
  std::uint32_t* block_counts;     // [ceil(N/256)] u32, visible ones of each block of cull_kernel
  std::uint32_t* block_starts;     // [ceil(N/256)] u32
  std::uint32_t* visible_rows;     // [V] u32, ascending
  Splat* splats;                   // [V], in the order of the rows
  std::uint32_t* tile_counts;      // [V] u32, tiles that each splat reaches
  std::uint32_t* depth_keys;       // [V] u32, bits of the depth, all ones beyond the count
  std::uint32_t* depth_values;     // [V] u32, splats
  std::uint32_t* depth_keys_out;   // [V] u32
  std::uint32_t* by_depth;         // [V] u32, splats nearest first, ties by row
  std::uint32_t* counts_by_depth;  // [V] u32
  std::uint32_t* starts_by_depth;  // [V] u32, each splat's first slot
  std::uint32_t* slot_starts;      // [V] u32, the same by splat
  std::uint32_t* slot_splats;      // [P] u32, the splat of each slot; slots of one splat lie together
  std::uint32_t* pair_keys;        // [P] u32, tile of each slot, all ones beyond the count
  std::uint32_t* pair_values;      // [P] u32, splats, or slots where the frame keeps them
  std::uint32_t* pair_keys_out;    // [P] u32
  std::uint32_t* pair_slots;   // [P] u32, slots tile by tile, nearest first; only where the frame keeps them
  std::uint32_t* pair_splats;  // [P] u32, splats tile by tile, nearest first
  std::uint32_t* tile_starts;  // [tiles + 1] u32 into pair_splats
  bool keeps_slots;
};

/// The first half: which Gaussians the picture shows, their splats in the order of rows.
[[nodiscard]] Status find_visible(const core::Stream& stream, const FrameOnDevice& frame,
                                  core::DeviceSort& sort);
/// The second half: pairs of tile and splat, tile by tile, nearest first.
[[nodiscard]] Status make_pairs(const core::Stream& stream, const FrameOnDevice& frame,
                                core::DeviceSort& sort);

/// Pictures on the device.
struct DevicePictures {
  float* colour;       // [H,W,3] f32
  float* depth_sum_m;  // [H,W] f32
  float* alpha;        // [H,W] f32
};
[[nodiscard]] Status blend_on_device(const core::Stream& stream, const FrameOnDevice& frame,
                                     const DevicePictures& out);

}  // namespace edgesplat::splat
