// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/gige_source.hpp"

#include "robot/drivers/aravis/pixel_format.hpp"

#include <cmath>
#include <memory>
#include <utility>

namespace edgesplat::aravis {
namespace {

constexpr std::uint32_t kNumbers = 65'535;  // 1..65535: 0 is never used
constexpr std::uint32_t kMaxHole = 10'000;  // 17 minutes at 10 Hz; a wider step is a camera that counts anew
constexpr std::int64_t kMaxMissed = 10'000;

/// From number `a` to `b`, with the 0 left out: 0..65534.
std::uint32_t steps_between(std::uint16_t a, std::uint16_t b) {
  return (std::uint32_t{b} + kNumbers - a) % kNumbers;
}

}  // namespace

GigeSource::GigeSource(const GigeCameraConfig& config, PictureSize expected)
    : config_(config), expected_(expected) {}

void GigeSource::restart() {
  if (newest_number_) ++counters_.restarts;
  newest_number_.reset();
  newest_counter_.reset();
}

std::optional<sensor::Measurement> GigeSource::on_frame(const RawFrame& frame, bool disciplined) {
  if (!frame.complete) {
    ++counters_.incomplete;  // its number is missing among those that follow: counted as lost there
    return std::nullopt;
  }
  if (!accept_number(frame)) {
    ++counters_.duplicate;
    return std::nullopt;
  }
  const bool any_size = expected_.width_px == 0 || expected_.height_px == 0;
  if (!any_size && (frame.width_px != expected_.width_px || frame.height_px != expected_.height_px)) {
    ++counters_.wrong_size;
    return std::nullopt;
  }
  const auto format = pixel_format_of(frame.pixel_format);
  auto image = format ? to_rgb8(*format, frame.width_px, frame.height_px, frame.pixels)
                      : fail(Errc::kBadPacket, "unknown pixel format");
  if (!image) {
    ++counters_.bad_pictures;
    return std::nullopt;
  }
  ++counters_.frames;
  sensor::CameraFrame out;
  out.stamp = middle_of_exposure(frame);
  out.arrival = frame.arrival;
  out.stamp_source = disciplined ? sensor::StampSource::kPtp : sensor::StampSource::kFreeRunning;
  out.sequence = sequence_;
  out.exposure_s = static_cast<float>(frame.exposure_us.value_or(config_.exposure_us) * 1e-6);
  out.gain_db = static_cast<float>(frame.gain_db.value_or(std::max(config_.gain_db, 0.0)));
  out.image = std::make_shared<const sensor::ImageRgb8>(*std::move(image));
  return out;
}

/// False for a frame that was seen or overtaken.
bool GigeSource::accept_number(const RawFrame& frame) {
  std::uint32_t step = 1;
  if (newest_number_) {
    step = steps_between(*newest_number_, frame.number);
    const bool backwards = step == 0 || step > kNumbers - kMaxHole;
    if (backwards && frame.stamp <= newest_stamp_) return false;
    if (backwards || step > kMaxHole) {
      restart();
      step = 1;
    } else {
      counters_.lost += step - 1;
    }
  }
  watch_pulses(frame, step);
  newest_number_ = frame.number;
  newest_stamp_ = frame.stamp;
  sequence_ += step;
  return true;
}

/// Pulses beyond the frames' numbers: the camera was too slow for them.
void GigeSource::watch_pulses(const RawFrame& frame, std::uint32_t step) {
  if (!frame.counter) return;
  if (newest_counter_) {
    const std::int64_t pulses = *frame.counter - *newest_counter_;
    if (pulses > step && pulses - step < kMaxMissed)
      counters_.missed_pulses += static_cast<std::uint64_t>(pulses - step);
  }
  newest_counter_ = frame.counter;
}

SensorTime GigeSource::middle_of_exposure(const RawFrame& frame) const {
  const SensorTime stamp = frame.chunk_stamp.value_or(frame.stamp);
  const nanoseconds half(std::llround(500.0 * frame.exposure_us.value_or(config_.exposure_us)));
  switch (config_.stamp_reference) {
    case StampReference::kStart:
      return stamp + half;
    case StampReference::kMiddle:
      return stamp;
    case StampReference::kEnd:
      return stamp - half;
  }
  return stamp;
}

}  // namespace edgesplat::aravis
