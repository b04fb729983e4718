// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/metrics/registry.hpp"
#include "common/sensor/rig.hpp"
#include "common/time/clock.hpp"
#include "robot/config/robot_config.hpp"
#include "robot/drivers/replay/recorder.hpp"
#include "robot/sync/triggered_stamps.hpp"

#include <functional>
#include <memory>
#include <stop_token>

namespace edgesplat::app {

/// The live camera, of whichever kind. receive() and publish_counters() belong to one thread at a time.
class CameraInput {
 public:
  using Sink = std::function<void(sensor::Measurement)>;

  virtual ~CameraInput() = default;
  /// Receives until `stop` is requested; what comes also goes to the recorder where there is one.
  virtual void receive(const std::stop_token& stop, const Sink& sink, replay::Recorder* recorder) = 0;
  /// "camera.*"; call after receive().
  virtual void publish_counters(metrics::Registry& metrics) const = 0;
};

/// The camera that the configuration names. Precondition: the rig has one. kInvalidConfig for bad settings,
/// kUnavailable where this build lacks the driver; a camera that is not there yet is no error. `pulses`,
/// where there are any, stamp the frames of a GigE camera whose clock is free; they must outlive the camera.
[[nodiscard]] Result<std::unique_ptr<CameraInput>> open_camera(const robot_config::CameraSettings& config,
                                                               const sensor::CameraMount& mount,
                                                               const Clock& clock,
                                                               sync::TriggeredStamps* pulses = nullptr);

}  // namespace edgesplat::app
