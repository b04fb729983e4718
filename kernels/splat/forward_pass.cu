// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels/splat/forward_pass.cuh"

#include "kernels/core/launch.cuh"

#include <algorithm>
#include <limits>
#include <span>

namespace edgesplat::splat {
namespace {

constexpr std::size_t kBlock = 256;  ///< of cull_kernel
constexpr std::size_t kMostPairs = std::size_t{1} << 31U;

std::size_t blocks_of(std::size_t count, std::size_t size) {
  return (count + size - 1) / size;
}

}  // namespace

ForwardPass::ForwardPass(core::VramPool& pool, bool keeps_slots)
    : sort_(pool),
      counts_(pool, "a frame's counts"),
      splats_(pool, "splats"),
      words_(pool, "the Gaussians in view"),
      visible_(pool, "the Gaussians in view"),
      pairs_(pool, "pairs of tile and splat"),
      tile_starts_(pool, "tiles") {
  frame_.keeps_slots = keeps_slots;
}

Status ForwardPass::make_room(const DeviceCloud& cloud, std::size_t tiles) {
  FrameRoom& room = frame_.room;
  room = {};
  if (cloud.size() > 0) {
    room.visible = next_.visible > 0 ? std::min(next_.visible, cloud.size()) : cloud.size() / 2 + 1;
    room.pairs = next_.pairs > 0 ? next_.pairs : 4 * room.visible;
  }
  const std::size_t arrays_of_pairs = frame_.keeps_slots ? 6 : 4;
  EDGESPLAT_TRY_STATUS(counts_.reserve(1));
  EDGESPLAT_TRY_STATUS(
      words_.reserve(blocks_of(cloud.size(), core::kWarp) + 2 * blocks_of(cloud.size(), kBlock)));
  EDGESPLAT_TRY_STATUS(splats_.reserve(room.visible));
  EDGESPLAT_TRY_STATUS(visible_.reserve(9 * room.visible));
  EDGESPLAT_TRY_STATUS(pairs_.reserve(arrays_of_pairs * room.pairs));
  return tile_starts_.reserve(tiles + 1);
}

void ForwardPass::point_to_buffers() {
  const std::size_t words = blocks_of(frame_.cloud.count, core::kWarp);
  const std::size_t blocks = blocks_of(frame_.cloud.count, kBlock);
  frame_.counts = counts_.data();
  frame_.splats = splats_.data();
  frame_.visible_words = words_.data();
  frame_.block_counts = words_.data() + words;
  frame_.block_starts = words_.data() + words + blocks;
  std::uint32_t* next = visible_.data();
  for (std::uint32_t** array : {&frame_.visible_rows, &frame_.tile_counts, &frame_.depth_keys,
                                &frame_.depth_values, &frame_.depth_keys_out, &frame_.by_depth,
                                &frame_.counts_by_depth, &frame_.starts_by_depth, &frame_.slot_starts}) {
    *array = next;
    next += frame_.room.visible;
  }
  next = pairs_.data();
  for (std::uint32_t** array : {&frame_.pair_keys, &frame_.pair_values, &frame_.pair_keys_out,
                                &frame_.pair_splats, &frame_.slot_splats, &frame_.pair_slots}) {
    const bool of_slots = array == &frame_.slot_splats || array == &frame_.pair_slots;
    *array = of_slots && !frame_.keeps_slots ? nullptr : next;
    next += frame_.room.pairs;
  }
  frame_.tile_starts = tile_starts_.data();
}

Status ForwardPass::start(const core::Stream& stream, DeviceCloud& cloud, const DeviceView& view,
                          const DevicePictures& out) {
  frame_.cloud = cloud.view();
  frame_.view = view;
  EDGESPLAT_TRY_STATUS(make_room(cloud, view.tiles()));
  point_to_buffers();
  EDGESPLAT_TRY_STATUS(find_visible(stream, frame_, sort_));
  EDGESPLAT_TRY_STATUS(make_pairs(stream, frame_, sort_));
  return blend_on_device(stream, frame_, out);
}

Result<FrameCounts> ForwardPass::wait(const core::Stream& stream) {
  FrameCounts counts{};
  EDGESPLAT_TRY_STATUS(core::download(stream, counts_, std::span(&counts, 1)));
  EDGESPLAT_TRY_STATUS(stream.synchronise());
  return counts;
}

Status ForwardPass::fit_room(const FrameCounts& counts) {
  if (counts.pairs > kMostPairs) {
    return fail(Errc::kOutOfVram, "the picture needs " + std::to_string(counts.pairs) +
                                      " pairs of tile and splat, more than 2^31: fewer or smaller Gaussians");
  }
  next_.visible = counts.visible + counts.visible / 4 + 1024;
  next_.pairs = static_cast<std::size_t>(counts.pairs + counts.pairs / 4) + 4096;
  return {};
}

Result<FrameCounts> ForwardPass::draw(const core::Stream& stream, DeviceCloud& cloud, const DeviceView& view,
                                      const DevicePictures& out) {
  // Once more for the visible ones, and once more for the pairs that only then are known.
  for (int tries = 0; tries < 3; ++tries) {
    EDGESPLAT_TRY_STATUS(start(stream, cloud, view, out));
    EDGESPLAT_TRY(const FrameCounts counts, wait(stream));
    const bool done = complete(counts);
    EDGESPLAT_TRY_STATUS(fit_room(counts));
    if (done) return counts;
  }
  return fail(Errc::kIo, "the GPU counts differently each time it draws the same picture: check its memory");
}

}  // namespace edgesplat::splat
