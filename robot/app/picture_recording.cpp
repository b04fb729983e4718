// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/app/picture_recording.hpp"

#include "common/io/image_file.hpp"
#include "common/log/log.hpp"

#include <utility>

namespace edgesplat::app {
namespace {

constexpr int kPngLevel = 1;

}  // namespace

void record_picture(const sensor::CameraFrame& frame, HostTime handed_on, replay::Recorder& recorder) {
  auto encoded = io::encode_png(*frame.image, kPngLevel);
  if (!encoded) {
    EDGESPLAT_LOG_WARN("recorder", "picture left out", "why", encoded.error().context);
    return;
  }
  frame_socket::EncodedFrame out;
  out.header.sequence = frame.sequence;
  out.header.stamp = frame.stamp;
  out.header.exposure_s = frame.exposure_s;
  out.header.gain_db = frame.gain_db;
  out.header.stamp_source = frame.stamp_source;
  out.header.format = frame_socket::PictureFormat::kPng;
  out.header.width_px = static_cast<std::uint16_t>(frame.image->width_px);
  out.header.height_px = static_cast<std::uint16_t>(frame.image->height_px);
  out.payload = *std::move(encoded);
  out.header.payload_bytes = static_cast<std::uint32_t>(out.payload.size());
  out.header.payload_crc32 = frame_socket::crc32(out.payload);
  recorder.on_frame(out, frame.arrival, handed_on);
}

}  // namespace edgesplat::app
