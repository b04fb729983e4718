// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace edgesplat::aravis {

/// A frame as the camera sent it, its bytes borrowed from the transport.
struct RawFrame {
  bool complete = false;     ///< every packet came; only then the rest means something
  std::uint16_t number = 0;  ///< 1..65535, then 1 again
  SensorTime stamp{};        ///< the camera's clock
  HostTime arrival{};        ///< of its first packet
  std::uint32_t pixel_format = 0;
  int width_px = 0;
  int height_px = 0;
  std::span<const std::byte> pixels;
  // From the chunks, where the camera appends them.
  std::optional<SensorTime> chunk_stamp;
  std::optional<double> exposure_us;
  std::optional<double> gain_db;
  std::optional<std::int64_t> counter;  ///< pulses on the trigger line, whether a frame came of them or not
};

}  // namespace edgesplat::aravis
