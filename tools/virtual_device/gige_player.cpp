// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/gige_player.hpp"

#include "common/io/image_file.hpp"

#include <utility>

namespace edgesplat::virtual_device {
namespace {

constexpr std::size_t kWaitingPictures = 8;

}  // namespace

Result<std::unique_ptr<GigePlayer>> GigePlayer::open(const GigeServerOptions& options, const Clock& clock) {
  EDGESPLAT_TRY(auto camera, GigeServer::open(options, clock));
  return std::unique_ptr<GigePlayer>(new GigePlayer(std::move(camera), clock));
}

GigePlayer::GigePlayer(std::unique_ptr<GigeServer> camera, const Clock& clock)
    : camera_(std::move(camera)),
      clock_(clock),
      queue_({.items = kWaitingPictures}, thread::Overflow::kDropOldest) {
  decoder_.emplace(thread::Worker::consume<Picture>("gige-decode", queue_,
                                                    [this](const Picture& picture) { expose(picture); }));
}

GigePlayer::~GigePlayer() {
  finish();
}

void GigePlayer::push(const FrameMessage& message, std::vector<std::byte> payload) {
  learn_clock(message);
  queue_.push({message, std::move(payload)});
}

void GigePlayer::learn_clock(const FrameMessage& message) {
  const SensorTime stamp = message.stamp;
  if (message.stamp_source == sensor::StampSource::kPtp) {
    if (clock_set_at_ && stamp > *clock_set_at_) return;  // it runs as the master's does
    clock_set_at_ = stamp;
    camera_->set_clock([stamp, then = clock_.now()](HostTime now) { return stamp + (now - then); });
    return;
  }
  host_from_stamp_.observe(stamp, clock_.now());
  const HostTime then = host_from_stamp_.to_host(stamp);
  const double rate = 1.0 + host_from_stamp_.drift_ppm() * 1e-6;
  camera_->set_clock(
      [stamp, then, rate](HostTime now) { return stamp + from_seconds(rate * to_seconds(now - then)); });
}

void GigePlayer::expose(const Picture& picture) {
  const FrameMessage& message = picture.message;
  auto image = io::decode_rgb8(picture.payload);
  const GigeCameraModel& model = camera_->model();
  if (!image || image->width_px != static_cast<int>(model.width_px) ||
      image->height_px != static_cast<int>(model.height_px)) {
    ++undecoded_;
    camera_->miss_pulse();
    return;
  }
  camera_->set_ptp(message.stamp_source == sensor::StampSource::kPtp);
  GigeExposure exposure;
  exposure.image = std::make_shared<const sensor::ImageRgb8>(*std::move(image));
  exposure.exposure_us = message.exposure_s * 1e6F;
  exposure.gain_db = message.gain_db;
  exposure.start = message.stamp - from_seconds(0.5 * static_cast<double>(message.exposure_s));
  camera_->push(std::move(exposure));
}

void GigePlayer::finish() {
  queue_.close();
  if (decoder_) decoder_->join();
  camera_->finish();
}

std::uint64_t GigePlayer::lost() const {
  return undecoded_ + queue_.stats().dropped + camera_->counters().frames_unsent;
}

}  // namespace edgesplat::virtual_device
