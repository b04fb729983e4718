// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/sensor/measurement.hpp"
#include "common/time/clock.hpp"
#include "common/time/clock_map.hpp"
#include "robot/drivers/aravis/aravis_camera.hpp"
#include "robot/drivers/aravis/camera_farewell.hpp"
#include "robot/drivers/aravis/camera_locator.hpp"
#include "robot/drivers/aravis/clock_watch.hpp"
#include "robot/drivers/aravis/gige_source.hpp"
#include "robot/drivers/aravis/silence_watch.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

namespace edgesplat::aravis {

struct SessionCounters {
  std::uint64_t opens = 0;         ///< the first one included
  std::uint64_t failed_opens = 0;  ///< attempts
  std::uint64_t silences = 0;      ///< frames stopped coming
  std::uint64_t control_losses = 0;
  std::uint64_t recoveries = 0;  ///< frames came again after one of these
  std::uint64_t moves = 0;       ///< it was found at another address
  nanoseconds longest_outage{};  ///< from the last frame before to the first after
};

/// A GigE Vision camera that comes back by itself. A camera that is not there is no error but a state. Frames
/// that stop (unplugged, half open, restarted, trigger line broken) are noticed after `silence_s`; it is
/// opened anew as soon as it answers, at whatever address: its serial number tells it. Each such event is one
/// line in the log and one in the counters.
/// Where its clock is free but can be read, a frame's arrival is the moment of its stamp by that: no
/// exposure, readout and transfer is in it. Thread-bound; Aravis' threads and one that asks for the clock are
/// inside.
class GigeCamera {
 public:
  /// kUnavailable where this build has no Aravis.
  static Result<std::unique_ptr<GigeCamera>> create(const GigeCameraConfig& config, PictureSize expected,
                                                    const Clock& clock);
  ~GigeCamera();
  GigeCamera(const GigeCamera&) = delete;
  GigeCamera& operator=(const GigeCamera&) = delete;

  /// Waits for the next frame, opening the camera where needed. Nothing when `stop` is requested or `timeout`
  /// has passed; an attempt to open a camera that answers badly may take some seconds longer.
  [[nodiscard]] std::optional<sensor::Measurement> receive(const std::stop_token& stop, nanoseconds timeout);

  [[nodiscard]] bool streaming() const { return state_ == State::kStreaming && !outage_since_; }
  /// The camera's clock is held to the master's.
  [[nodiscard]] bool disciplined() const { return watch_ && watch_->disciplined(); }
  [[nodiscard]] const GigeCounters& counters() const { return source_.counters(); }
  [[nodiscard]] const SessionCounters& session_counters() const { return session_; }
  /// Over all openings.
  [[nodiscard]] StreamStatistics statistics() const;

 private:
  enum class State : std::uint8_t {
    kClosed,    ///< try to open at retry_at_
    kSettling,  ///< open, waits for PTP before the first frame
    kStreaming,
    kGone,  ///< open, but does not answer
  };
  GigeCamera(const GigeCameraConfig& config, PictureSize expected, const Clock& clock);
  void try_open(const std::stop_token& stop);
  [[nodiscard]] Whereabouts locate(const std::stop_token& stop);
  void note_failed_open(const std::string& why);
  void close(bool answers);
  void settle(const std::stop_token& stop, nanoseconds limit);
  [[nodiscard]] std::optional<sensor::Measurement> stream(const std::stop_token& stop, nanoseconds limit);
  void look_after(const std::stop_token& stop);
  void wait_for_return(const std::stop_token& stop, nanoseconds limit);
  void start();
  void read_clock();
  void place_arrival(sensor::CameraFrame& frame);
  void note_outage(std::uint64_t& counter, const std::string& why);
  void note_recovery();
  [[nodiscard]] nanoseconds patience() const;

  GigeCameraConfig config_;
  const Clock& clock_;
  GigeSource source_;
  State state_ = State::kClosed;
  std::unique_ptr<AravisCamera> camera_;
  CameraLocator locator_;
  std::unique_ptr<ClockWatch> watch_;
  HostTime retry_at_{};
  HostTime settle_until_{};
  SilenceWatch silence_;    ///< since the last frame, or the start of the acquisition
  bool had_frame_ = false;  ///< since it was opened
  int idle_opens_ = 0;      ///< openings in a row of which no frame came
  bool said_absent_ = false;
  std::optional<HostTime> outage_since_;
  std::optional<ClockMap> host_from_camera_;  ///< from readings of the camera's clock
  nanoseconds best_round_trip_{};             ///< of those
  SessionCounters session_;
  StreamStatistics earlier_;  ///< of cameras that were closed
  CameraFarewell farewell_;
};

}  // namespace edgesplat::aravis
