// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"
#include "common/time/clock_map.hpp"
#include "tools/virtual_device/frame_message.hpp"
#include "tools/virtual_device/gige_server.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace edgesplat::virtual_device {

/// Recorded pictures as the exposures of a GigE Vision camera: decodes them on a thread of its own, so that
/// the other devices are not delayed. The clock that the camera shows when asked is that of the recorded
/// stamps, later by the latency of the first picture (a free one: by the least latency). Thread-bound.
class GigePlayer {
 public:
  /// Errors of GigeServer::open.
  static Result<std::unique_ptr<GigePlayer>> open(const GigeServerOptions& options, const Clock& clock);
  ~GigePlayer();
  GigePlayer(const GigePlayer&) = delete;
  GigePlayer& operator=(const GigePlayer&) = delete;

  [[nodiscard]] GigeServer& camera() { return *camera_; }
  /// One pulse of the trigger line. The message's stamp is the middle of the exposure; a picture that is
  /// damaged or not of the sensor's size is a pulse without a frame.
  void push(const FrameMessage& message, std::vector<std::byte> payload);
  /// Sends what waits.
  void finish();
  /// Pictures that no robot got.
  [[nodiscard]] std::uint64_t lost() const;

 private:
  struct Picture {
    FrameMessage message;
    std::vector<std::byte> payload;
  };
  GigePlayer(std::unique_ptr<GigeServer> camera, const Clock& clock);
  void learn_clock(const FrameMessage& message);
  void expose(const Picture& picture);

  std::unique_ptr<GigeServer> camera_;
  const Clock& clock_;
  ClockMap host_from_stamp_;
  std::optional<SensorTime> clock_set_at_;  ///< a disciplined clock: once
  thread::BoundedQueue<Picture> queue_;
  std::atomic<std::uint64_t> undecoded_{0};
  std::optional<thread::Worker> decoder_;
};

}  // namespace edgesplat::virtual_device
