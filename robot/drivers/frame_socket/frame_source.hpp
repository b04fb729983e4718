// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "robot/drivers/frame_socket/frame_assembler.hpp"

#include <cstdint>
#include <optional>

namespace edgesplat::frame_socket {

/// Size that every picture must have; 0 = any. Comes from the rig: another size does not fit its intrinsics.
struct PictureSize {
  int width_px = 0;
  int height_px = 0;
};

struct FrameCounters {
  std::uint64_t frames = 0;        ///< handed on
  std::uint64_t lost = 0;          ///< holes in the sequence
  std::uint64_t duplicate = 0;     ///< seen before, or older than one seen: not used
  std::uint64_t restarts = 0;      ///< the camera counts anew
  std::uint64_t bad_pictures = 0;  ///< could not be decoded, or differ from what their header says
  std::uint64_t wrong_size = 0;    ///< not the size of the rig's camera
};

/// Checked messages of the camera to CameraFrames: decodes the picture and watches the sequence.
/// Thread-bound; cost: decoding, some ms a picture.
class FrameSource {
 public:
  explicit FrameSource(PictureSize expected = {}) : expected_(expected) {}

  [[nodiscard]] std::optional<sensor::Measurement> on_frame(const EncodedFrame& frame, HostTime arrival);
  [[nodiscard]] const FrameCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] bool accept_sequence(const FrameHeader& header);

  PictureSize expected_;
  std::optional<std::uint32_t> newest_sequence_;
  SensorTime newest_stamp_{};
  FrameCounters counters_;
};

}  // namespace edgesplat::frame_socket
