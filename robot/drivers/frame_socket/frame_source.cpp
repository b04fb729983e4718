// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/frame_socket/frame_source.hpp"

#include "common/io/image_file.hpp"

#include <memory>
#include <utility>

namespace edgesplat::frame_socket {
namespace {

constexpr std::uint32_t kMaxHole = 100'000;  // an hour at 30 Hz; a wider step is a camera that started anew

}  // namespace

std::optional<sensor::Measurement> FrameSource::on_frame(const EncodedFrame& frame, HostTime arrival) {
  const FrameHeader& header = frame.header;
  if (!accept_sequence(header)) {
    ++counters_.duplicate;
    return std::nullopt;
  }
  const bool any_size = expected_.width_px == 0 || expected_.height_px == 0;
  if (!any_size && (header.width_px != expected_.width_px || header.height_px != expected_.height_px)) {
    ++counters_.wrong_size;
    return std::nullopt;
  }
  auto image = io::decode_rgb8(frame.payload);
  if (!image || image->width_px != header.width_px || image->height_px != header.height_px) {
    ++counters_.bad_pictures;
    return std::nullopt;
  }
  ++counters_.frames;
  sensor::CameraFrame out;
  out.stamp = header.stamp;
  out.arrival = arrival;
  out.stamp_source = header.stamp_source;
  out.sequence = header.sequence;
  out.exposure_s = header.exposure_s;
  out.gain_db = header.gain_db;
  out.image = std::make_shared<const sensor::ImageRgb8>(*std::move(image));
  return out;
}

/// False for a frame that was seen or overtaken. A camera that counts anew is believed at once: its stamps go
/// on or start anew too, which the time base sorts out.
bool FrameSource::accept_sequence(const FrameHeader& header) {
  if (newest_sequence_) {
    const std::uint32_t step = header.sequence - *newest_sequence_;
    if (header.stamp <= newest_stamp_ && (step == 0 || step > 0U - kMaxHole)) return false;
    if (step == 0 || step > kMaxHole) {
      ++counters_.restarts;
    } else {
      counters_.lost += step - 1;
    }
  }
  newest_sequence_ = header.sequence;
  newest_stamp_ = header.stamp;
  return true;
}

}  // namespace edgesplat::frame_socket
