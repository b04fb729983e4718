// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "robot/drivers/replay/recorder.hpp"

namespace edgesplat::app {

/// A camera that sends raw pixels, to a recording: as PNG, so that a replay has the same pixels. A picture
/// that cannot be encoded is logged and left out. `handed_on`: see Recorder::on_frame.
void record_picture(const sensor::CameraFrame& frame, HostTime handed_on, replay::Recorder& recorder);

}  // namespace edgesplat::app
