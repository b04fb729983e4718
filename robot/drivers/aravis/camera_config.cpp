// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/camera_config.hpp"

namespace edgesplat::aravis {

using config::Range;

void describe(config::ConfigReader& reader, GigeCameraConfig& c) {
  reader.field("address", c.address, "IPv4 address of the camera, or the name by which discovery finds it");
  reader.field("serial", c.serial_number, "the camera to use, wherever it is; empty: the one at address");
  reader.choice("trigger", c.trigger, {{"line", Trigger::kLine}, {"free", Trigger::kFree}},
                "line = a pulse on trigger_source exposes, free = the camera's own rate");
  reader.field("trigger_source", c.trigger_source, "the camera's name of the trigger line");
  reader.field("input_latency_us", c.input_latency_us, Range{0.0, 1000.0}, "from the pulse to the exposure");
  reader.field("frame_rate_hz", c.frame_rate_hz, Range{0.1, 200.0}, "where the camera runs freely");
  reader.field("exposure_us", c.exposure_us, Range{0.0, 100000.0}, "0 = automatic");
  reader.field("gain_db", c.gain_db, Range{-1.0, 48.0}, "-1 = automatic");
  reader.field("gain_raw_per_db", c.gain_raw_per_db, Range{0.1, 1000.0},
               "for cameras that have GainRaw alone; their manual tells");
  reader.choice(
      "pixel_format", c.pixel_format,
      {{"Mono8", PixelFormat::kMono8}, {"BayerRG8", PixelFormat::kBayerRg8}, {"RGB8", PixelFormat::kRgb8}},
      "what the camera sends");
  reader.field("packet_bytes", c.packet_bytes, {0, 9000}, "0 = the largest that gets through");
  reader.field("buffers", c.buffers, {4, 64}, "frames that may wait");
  reader.field("ptp", c.ptp, "discipline the camera's clock where it can be");
  reader.field("ptp_offset_limit_us", c.ptp_offset_limit_us, Range{0.1, 1000.0},
               "closer to the master than this ...");
  reader.field("ptp_settle_s", c.ptp_settle_s, Range{0.0, 60.0},
               "... for this long: the clock counts as disciplined");
  reader.field("ptp_wait_s", c.ptp_wait_s, Range{0.0, 120.0},
               "wait this long for that before the first frame");
  reader.choice(
      "stamp_reference", c.stamp_reference,
      {{"start", StampReference::kStart}, {"middle", StampReference::kMiddle}, {"end", StampReference::kEnd}},
      "which moment of the exposure the camera stamps");
  reader.field("silence_s", c.silence_s, Range{0.1, 60.0}, "no frame this long: look after the camera");
  reader.field("heartbeat_timeout_s", c.heartbeat_timeout_s, Range{0.5, 60.0},
               "the camera frees itself of a robot that is silent this long");
}

}  // namespace edgesplat::aravis
