// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/gige_camera.hpp"

#include "common/log/log.hpp"
#include "common/thread/pause.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace edgesplat::aravis {
namespace {

constexpr auto kRetry = std::chrono::milliseconds(300);
constexpr auto kSearchPause = std::chrono::milliseconds(100);
constexpr auto kMostLatency = std::chrono::milliseconds(500);  // exposure, readout and transfer
constexpr auto kMoreRoundTrip = std::chrono::microseconds(100);
constexpr auto kFirstQuestion = std::chrono::milliseconds(500);
constexpr auto kFirstFramePatience = std::chrono::seconds(2);  // the trigger may begin later than the camera

std::string joined(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : "; ") + part;
  return out;
}

StreamStatistics sum(const StreamStatistics& a, const StreamStatistics& b) {
  return {a.completed + b.completed, a.failed + b.failed, a.underruns + b.underruns,
          a.packets_resent + b.packets_resent, a.packets_missing + b.packets_missing};
}

}  // namespace

Result<std::unique_ptr<GigeCamera>> GigeCamera::create(const GigeCameraConfig& config, PictureSize expected,
                                                       const Clock& clock) {
  if (!has_aravis())
    return fail(
        Errc::kUnavailable,
        "camera.source = \"gige\" needs libaravis, which this program was built without; run tools/setup "
        "and build again");
  return std::unique_ptr<GigeCamera>(new GigeCamera(config, expected, clock));
}

GigeCamera::GigeCamera(const GigeCameraConfig& config, PictureSize expected, const Clock& clock)
    : config_(config), clock_(clock), source_(config, expected), locator_(config) {}

GigeCamera::~GigeCamera() {
  if (camera_) close(locator_.answers({}));
}

std::optional<sensor::Measurement> GigeCamera::receive(const std::stop_token& stop, nanoseconds timeout) {
  const HostTime until = clock_.now() + timeout;
  while (!stop.stop_requested()) {
    const nanoseconds left = until - clock_.now();
    if (left <= nanoseconds(0)) return std::nullopt;
    switch (state_) {
      case State::kClosed:
        if (clock_.now() >= retry_at_) {
          try_open(stop);
        } else {
          thread::pause(stop, std::min(left, retry_at_ - clock_.now()));
        }
        break;
      case State::kSettling:
        settle(stop, left);
        break;
      case State::kStreaming:
        if (auto frame = stream(stop, left)) return frame;
        break;
      case State::kGone:
        wait_for_return(stop, left);
        break;
    }
  }
  return std::nullopt;
}

Whereabouts GigeCamera::locate(const std::stop_token& stop) {
  const std::string before = locator_.address();
  const Whereabouts where = locator_.locate(stop);
  if (where == Whereabouts::kElsewhere) {
    ++session_.moves;
    EDGESPLAT_LOG_WARN("camera", "has another address", "serial", locator_.serial_number(), "from", before,
                       "to", locator_.address());
  }
  return where;
}

void GigeCamera::note_failed_open(const std::string& why) {
  ++session_.failed_opens;
  if (!said_absent_ && !outage_since_) EDGESPLAT_LOG_WARN("camera", "not there yet", "why", why);
  said_absent_ = true;
  retry_at_ = clock_.now() + kRetry;
}

void GigeCamera::try_open(const std::stop_token& stop) {
  if (locate(stop) == Whereabouts::kAway) {
    if (!stop.stop_requested()) note_failed_open("no camera " + locator_.sought() + " answers");
    return;
  }
  config_.address = locator_.address();
  auto opened = AravisCamera::open(config_, clock_);
  if (!opened) {
    note_failed_open(opened.error().context);
    return;
  }
  ++session_.opens;
  camera_ = *std::move(opened);
  locator_.meet(camera_->address(), stop);
  watch_ = std::make_unique<ClockWatch>(*camera_, config_, clock_);
  source_.restart();
  had_frame_ = false;
  if (session_.opens == 1) {
    EDGESPLAT_LOG_INFO("camera", "opened", "name", camera_->name(), "packet_bytes", camera_->packet_bytes(),
                       "ptp", camera_->abilities().ptp_status, "exposure", camera_->abilities().exposure,
                       "gain", camera_->abilities().gain, "chunks", camera_->abilities().chunks.size(),
                       "without", joined(camera_->abilities().without));
  }
  // After an outage frames matter more than the last microseconds: they come at once, fitted to the host's
  // clock.
  if (!outage_since_ && session_.opens == 1 && camera_->abilities().has_ptp() && config_.ptp_wait_s > 0) {
    settle_until_ = clock_.now() + from_seconds(config_.ptp_wait_s);
    state_ = State::kSettling;
    return;
  }
  start();
}

void GigeCamera::settle(const std::stop_token& stop, nanoseconds limit) {
  const nanoseconds left = settle_until_ - clock_.now();
  const bool disciplined = watch_->wait_until_disciplined(stop, std::min(left, limit));
  if (stop.stop_requested()) return;
  if (disciplined) {
    EDGESPLAT_LOG_INFO("camera", "clock disciplined");
  } else if (clock_.now() < settle_until_) {
    return;
  } else {
    const auto ptp = watch_->ptp();
    EDGESPLAT_LOG_WARN("camera", "clock not disciplined, its stamps are fitted to the host's clock", "status",
                       ptp ? ptp->status : "no answer", "waited_s", config_.ptp_wait_s);
  }
  start();
}

void GigeCamera::start() {
  watch_->wait_for_question(kFirstQuestion);
  if (const Status started = camera_->start(); !started) {
    ++session_.failed_opens;
    close(locator_.answers({}));
    return;
  }
  silence_.heard(clock_.now());
  state_ = State::kStreaming;
}

void GigeCamera::close(bool answers) {
  host_from_camera_.reset();
  if (camera_) earlier_ = sum(earlier_, camera_->statistics());
  if (!answers) farewell_.close(std::move(camera_), std::move(watch_));
  watch_.reset();
  camera_.reset();
  state_ = State::kClosed;
  retry_at_ = clock_.now();
}

/// How long no frame may come. Where none came of some openings it is left open for longer and longer: then
/// nothing is wrong with the connection, but with the trigger.
nanoseconds GigeCamera::patience() const {
  const nanoseconds silence = from_seconds(config_.silence_s);
  if (had_frame_) return silence;
  if (!outage_since_) return std::max<nanoseconds>(kFirstFramePatience, silence);
  return std::min<nanoseconds>(silence * (1 + idle_opens_),
                               std::max<nanoseconds>(kFirstFramePatience, silence));
}

std::optional<sensor::Measurement> GigeCamera::stream(const std::stop_token& stop, nanoseconds limit) {
  const HostTime begin = clock_.now();
  const nanoseconds wait = std::clamp(patience() - silence_.silence(begin), nanoseconds(0), limit);
  const auto raw = camera_->receive(stop, wait);
  if (raw) {
    auto frame = source_.on_frame(*raw, disciplined());
    if (!raw->complete) {
      silence_.heard(clock_.now());  // the camera sends; packets get lost
      return std::nullopt;
    }
    read_clock();
    // With a disciplined clock nothing is fitted, and when it came is what a recording is to tell.
    if (frame && !disciplined()) place_arrival(std::get<sensor::CameraFrame>(*frame));
    if (outage_since_) note_recovery();
    silence_.heard(clock_.now());
    had_frame_ = true;
    idle_opens_ = 0;
    return frame;
  }
  if (stop.stop_requested()) return std::nullopt;
  silence_.listened(begin, clock_.now(), wait);
  if (camera_->control_lost()) {
    note_outage(session_.control_losses, "it no longer obeys: restarted, or another program took it");
    close(locator_.answers(stop));
  } else if (silence_.silence(clock_.now()) >= patience()) {
    look_after(stop);
  }
  return std::nullopt;
}

void GigeCamera::read_clock() {
  const auto reading = watch_->take_reading();
  if (!reading) return;
  // A question that was long on the way tells less: the answer lies anywhere in between.
  if (!host_from_camera_) best_round_trip_ = reading->round_trip;
  best_round_trip_ = std::min(best_round_trip_, reading->round_trip);
  if (host_from_camera_ && reading->round_trip > 2 * best_round_trip_ + kMoreRoundTrip) return;
  if (!host_from_camera_) host_from_camera_.emplace();
  host_from_camera_->observe(reading->device, reading->host);
}

/// The moment of the stamp, unless the camera's clock jumped since it was read.
void GigeCamera::place_arrival(sensor::CameraFrame& frame) {
  if (!host_from_camera_) return;
  const HostTime moment = host_from_camera_->to_host(frame.stamp);
  if (std::chrono::abs(frame.arrival - moment) < kMostLatency) {
    frame.arrival = moment;
  } else {
    host_from_camera_.reset();
  }
}

/// No frames come: is the camera there at all?
void GigeCamera::look_after(const std::stop_token& stop) {
  const bool there = locator_.answers(stop);
  note_outage(session_.silences, there ? "it answers, but no frames come: trigger or network"
                                       : "it does not answer: power or cable");
  if (!had_frame_) ++idle_opens_;
  if (there) {
    close(true);
  } else {
    state_ = State::kGone;
  }
}

void GigeCamera::wait_for_return(const std::stop_token& stop, nanoseconds limit) {
  const Whereabouts where = locate(stop);
  if (where == Whereabouts::kAway) {
    thread::pause(stop, std::min<nanoseconds>(kSearchPause, limit));
  } else {
    close(where != Whereabouts::kElsewhere);
  }
}

void GigeCamera::note_outage(std::uint64_t& counter, const std::string& why) {
  if (outage_since_) return;  // still the same one
  ++counter;
  outage_since_ = silence_.last_heard();
  EDGESPLAT_LOG_WARN("camera", "frames stopped", "why", why);
}

void GigeCamera::note_recovery() {
  const nanoseconds outage = clock_.now() - *outage_since_;
  session_.longest_outage = std::max(session_.longest_outage, outage);
  ++session_.recoveries;
  EDGESPLAT_LOG_INFO("camera", "frames come again", "after_s", to_seconds(outage));
  outage_since_.reset();
}

StreamStatistics GigeCamera::statistics() const {
  return camera_ ? sum(earlier_, camera_->statistics()) : earlier_;
}

}  // namespace edgesplat::aravis
