// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"
#include "robot/drivers/aravis/pixel_format.hpp"

#include <cstdint>
#include <string>

namespace edgesplat::aravis {

enum class Trigger : std::uint8_t {
  kLine,  ///< a pulse on trigger_source exposes
  kFree,  ///< the camera's own rate
};

/// What the camera's stamp says about the exposure; the camera's manual tells.
enum class StampReference : std::uint8_t { kStart, kMiddle, kEnd };

/// How a GigE Vision camera is to be used.
struct GigeCameraConfig {
  std::string address = "192.168.1.20";  ///< IPv4 address, or the name by which discovery finds it
  std::string serial_number;             ///< the camera to use, wherever it is; empty: the one at `address`
  Trigger trigger = Trigger::kLine;
  std::string trigger_source = "Line0";
  double input_latency_us =
      0.0;  ///< from the pulse's edge to the exposure, [0, 1000]: opto-couplers take 1 to 30
  double frame_rate_hz = 10.0;    ///< kFree, [0.1, 200]
  double exposure_us = 5000.0;    ///< [10, 100000]; 0 = automatic
  double gain_db = 0.0;           ///< [0, 48]; -1 = automatic
  double gain_raw_per_db = 10.0;  ///< for cameras that have GainRaw alone; their manual tells, [0.1, 1000]
  PixelFormat pixel_format = PixelFormat::kBayerRg8;
  int packet_bytes = 0;  ///< with IP and UDP headers, [256, 9000]; 0 = the largest that gets through
  int buffers = 12;      ///< frames that Aravis may hold, [4, 64]
  bool ptp = true;       ///< discipline the camera's clock where it can be
  double ptp_offset_limit_us = 10.0;  ///< closer to the master than this, [0.1, 1000] ...
  double ptp_settle_s = 5.0;          ///< ... for this long: the clock counts as disciplined, [0, 60]
  double ptp_wait_s = 12.0;           ///< before the first frame, then on without, [0, 120]
  StampReference stamp_reference = StampReference::kStart;
  double silence_s = 0.6;  ///< no frame this long: something is wrong, [0.1, 60]
  double heartbeat_timeout_s =
      3.0;  ///< the camera frees itself of a robot that is silent this long, [0.5, 60]
};

void describe(config::ConfigReader& reader, GigeCameraConfig& config);

}  // namespace edgesplat::aravis
