// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/time/clock.hpp"
#include "tools/virtual_device/frame_message.hpp"
#include "tools/virtual_device/stream.hpp"

#include <chrono>
#include <cstddef>
#include <memory>
#include <stop_token>
#include <vector>

namespace edgesplat::virtual_device {

/// The camera that a recording's pictures come from. Thread-bound.
class CameraEnd {
 public:
  virtual ~CameraEnd() = default;
  /// Call before the first push(). False when nobody came in time, or a stop was requested.
  virtual bool wait_for_robot(std::chrono::milliseconds timeout, const std::stop_token& stop) = 0;
  virtual void push(const FrameMessage& frame, std::vector<std::byte> encoded) = 0;
  /// Sends what waits and reports what became of the pictures.
  virtual void finish(StreamReport& report) = 0;
};

/// The kind that the options name. kNotFound where a GigE Vision camera would have no picture; errors of its
/// server.
[[nodiscard]] Result<std::unique_ptr<CameraEnd>> open_camera(const StreamOptions& options,
                                                             const Clock& clock);

}  // namespace edgesplat::virtual_device
