// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "robot/drivers/aravis/camera_config.hpp"
#include "robot/drivers/aravis/raw_frame.hpp"

#include <cstdint>
#include <optional>

namespace edgesplat::aravis {

/// Size that every picture must have; 0 = any. Comes from the rig: another size does not fit its intrinsics.
struct PictureSize {
  int width_px = 0;
  int height_px = 0;
};

struct GigeCounters {
  std::uint64_t frames = 0;         ///< handed on
  std::uint64_t lost = 0;           ///< holes in the camera's numbers, incomplete frames among them
  std::uint64_t incomplete = 0;     ///< packets missing for good: not used
  std::uint64_t missed_pulses = 0;  ///< the camera counted a pulse of which no frame came
  std::uint64_t duplicate = 0;      ///< not newer than one seen: not used
  std::uint64_t restarts = 0;       ///< the camera counts anew
  std::uint64_t bad_pictures = 0;   ///< unknown pixel format, or too few bytes
  std::uint64_t wrong_size = 0;     ///< not the size of the rig's camera
};

/// The camera's frames to CameraFrames: numbers without wrap, the stamp carried to the middle of the
/// exposure, pixels to colour. Thread-bound; cost: one copy or interpolation of a picture.
class GigeSource {
 public:
  GigeSource(const GigeCameraConfig& config, PictureSize expected);

  /// `disciplined`: the camera's clock is held to the master's at present.
  [[nodiscard]] std::optional<sensor::Measurement> on_frame(const RawFrame& frame, bool disciplined);
  /// The camera was opened anew: its numbers and its clock may begin again.
  void restart();
  [[nodiscard]] const GigeCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] bool accept_number(const RawFrame& frame);
  void watch_pulses(const RawFrame& frame, std::uint32_t step);
  [[nodiscard]] SensorTime middle_of_exposure(const RawFrame& frame) const;

  GigeCameraConfig config_;
  PictureSize expected_;
  std::optional<std::uint16_t> newest_number_;
  std::optional<std::int64_t> newest_counter_;
  SensorTime newest_stamp_{};
  std::uint32_t sequence_ = 0;  ///< of the newest frame, counted on over wraps and restarts
  GigeCounters counters_;
};

}  // namespace edgesplat::aravis
