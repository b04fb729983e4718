// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/splat/device_frame.cuh"

namespace edgesplat::splat {

/// From Gaussians on the device to pictures on the device, without waiting: buffers and sorts have the room
/// that the frames before needed and a quarter more, the device counts what this one needs, and a frame that
/// needed more is drawn again. Single-owner, bound to one stream at a time.
class ForwardPass {
 public:
  /// `keeps_slots`: number the pairs so that each tile can leave its sums by splat and tile (training, in a
  /// fixed order).
  ForwardPass(core::VramPool& pool, bool keeps_slots);

  /// Puts the frame into the stream. `cloud` and `out` must stay until it is done. kOutOfVram.
  [[nodiscard]] Status start(const core::Stream& stream, DeviceCloud& cloud, const DeviceView& view,
                             const DevicePictures& out);
  /// Waits for the stream and tells what the frame needed.
  [[nodiscard]] Result<FrameCounts> wait(const core::Stream& stream);
  /// Whether the frame had the room it needed.
  [[nodiscard]] bool complete(const FrameCounts& counts) const {
    return counts.visible <= frame_.room.visible && counts.pairs <= frame_.room.pairs;
  }
  /// Room for the next frame after one that needed this. kOutOfVram where pairs cannot be numbered any more.
  [[nodiscard]] Status fit_room(const FrameCounts& counts);
  /// start(), wait() and again until it is complete.
  [[nodiscard]] Result<FrameCounts> draw(const core::Stream& stream, DeviceCloud& cloud,
                                         const DeviceView& view, const DevicePictures& out);

  [[nodiscard]] const FrameOnDevice& frame() const { return frame_; }

 private:
  [[nodiscard]] Status make_room(const DeviceCloud& cloud, std::size_t tiles);
  void point_to_buffers();

  core::DeviceSort sort_;
  core::DeviceBuffer<FrameCounts> counts_;
  core::DeviceBuffer<Splat> splats_;
  core::DeviceBuffer<std::uint32_t> words_;    ///< of the Gaussians: bits, counts and starts of blocks
  core::DeviceBuffer<std::uint32_t> visible_;  ///< nine arrays [V]
  core::DeviceBuffer<std::uint32_t> pairs_;    ///< five or six arrays [P]
  core::DeviceBuffer<std::uint32_t> tile_starts_;
  FrameOnDevice frame_{};
  FrameRoom next_;  ///< 0: nothing is known yet
};

}  // namespace edgesplat::splat
