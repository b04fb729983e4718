// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/thread/worker.hpp"
#include "common/time/clock.hpp"
#include "robot/drivers/aravis/aravis_camera.hpp"
#include "robot/drivers/aravis/ptp_judge.hpp"

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <stop_token>

namespace edgesplat::aravis {

/// Asks an open camera about its clock, on a thread of its own: a camera that does not answer blocks the
/// question for seconds, which must not delay frames nor the discovery that it is gone. Thread-safe.
class ClockWatch {
 public:
  /// `camera` must outlive it.
  ClockWatch(AravisCamera& camera, const GigeCameraConfig& config, const Clock& clock);
  ClockWatch(const ClockWatch&) = delete;
  ClockWatch& operator=(const ClockWatch&) = delete;

  [[nodiscard]] bool disciplined() const;
  /// Waits until the clock counts as disciplined; false at the time limit, or at once where the camera has no
  /// PTP.
  [[nodiscard]] bool wait_until_disciplined(const std::stop_token& stop, nanoseconds limit);
  /// Waits until the camera was asked once.
  void wait_for_question(nanoseconds limit);
  /// The newest reading of the camera's clock, once.
  [[nodiscard]] std::optional<AravisCamera::ClockReading> take_reading();
  [[nodiscard]] std::optional<PtpReading> ptp() const;

 private:
  bool step(const std::stop_token& stop);

  AravisCamera& camera_;
  const Clock& clock_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  PtpJudge judge_;
  bool asked_ = false;
  std::optional<PtpReading> ptp_;
  std::optional<AravisCamera::ClockReading> reading_;
  thread::Worker worker_;
};

}  // namespace edgesplat::aravis
