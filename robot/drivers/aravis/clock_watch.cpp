// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/aravis/clock_watch.hpp"

#include <chrono>
#include <utility>

namespace edgesplat::aravis {
namespace {

constexpr auto kPeriod = std::chrono::milliseconds(250);
constexpr int kQuestions = 3;  // the one with the shortest round trip counts

}  // namespace

ClockWatch::ClockWatch(AravisCamera& camera, const GigeCameraConfig& config, const Clock& clock)
    : camera_(camera),
      clock_(clock),
      judge_(config.ptp_offset_limit_us, config.ptp_settle_s),
      worker_("camera-clock", [this](const std::stop_token& stop) { return step(stop); }) {}

bool ClockWatch::step(const std::stop_token& stop) {
  const bool has_ptp = camera_.abilities().has_ptp();
  std::optional<PtpReading> ptp;
  if (has_ptp) {
    if (auto reading = camera_.read_ptp()) ptp = *std::move(reading);
  }
  std::optional<AravisCamera::ClockReading> best;
  const bool readable = !camera_.abilities().clock_latch.empty() && !camera_.abilities().clock_value.empty();
  for (int i = 0; readable && i < kQuestions && !stop.stop_requested(); ++i) {
    const auto reading = camera_.read_clock();
    if (!reading) break;
    if (!best || reading->round_trip < best->round_trip) best = *reading;
  }
  if (stop.stop_requested()) return false;
  std::unique_lock lock(mutex_);
  if (ptp) judge_.observe(*ptp, clock_.now());
  if (ptp) ptp_ = std::move(ptp);
  if (best) reading_ = best;
  asked_ = true;
  changed_.notify_all();
  (void)changed_.wait_for(lock, stop, kPeriod, [] { return false; });
  return !stop.stop_requested();
}

bool ClockWatch::disciplined() const {
  const std::lock_guard lock(mutex_);
  return judge_.disciplined();
}

bool ClockWatch::wait_until_disciplined(const std::stop_token& stop, nanoseconds limit) {
  if (!camera_.abilities().has_ptp()) return false;
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, stop, limit, [this] { return judge_.disciplined(); });
}

void ClockWatch::wait_for_question(nanoseconds limit) {
  std::unique_lock lock(mutex_);
  (void)changed_.wait_for(lock, limit, [this] { return asked_; });
}

std::optional<AravisCamera::ClockReading> ClockWatch::take_reading() {
  const std::lock_guard lock(mutex_);
  return std::exchange(reading_, std::nullopt);
}

std::optional<PtpReading> ClockWatch::ptp() const {
  const std::lock_guard lock(mutex_);
  return ptp_;
}

}  // namespace edgesplat::aravis
