// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/time/clock.hpp"
#include "robot/drivers/aravis/camera_setup.hpp"
#include "robot/drivers/aravis/raw_frame.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

namespace edgesplat::aravis {

/// What libaravis counted since the camera was opened.
struct StreamStatistics {
  std::uint64_t completed = 0;        ///< frames, every packet there
  std::uint64_t failed = 0;           ///< frames given up
  std::uint64_t underruns = 0;        ///< no free buffer: this program was too slow
  std::uint64_t packets_resent = 0;   ///< asked for again and got
  std::uint64_t packets_missing = 0;  ///< never got
};

/// A GigE Vision camera that is open and set up: the transport, on libaravis, whose headers nobody else sees.
/// A thread of Aravis' own receives packets; frames wait in a fixed number of buffers. One thread calls
/// receive(); read_ptp() and read_clock() may be called from another.
class AravisCamera {
 public:
  /// Finds the camera, takes control of it, tests the packet size, sets it up and makes the buffers; does not
  /// start. Blocks up to some seconds where it answers badly. kUnavailable: not there, in use by another
  /// program, or this build has no Aravis; others from set_up_camera().
  static Result<std::unique_ptr<AravisCamera>> open(const GigeCameraConfig& config, const Clock& clock);
  /// Gives the camera back. Blocks some seconds where it does not answer.
  ~AravisCamera();
  AravisCamera(const AravisCamera&) = delete;
  AravisCamera& operator=(const AravisCamera&) = delete;

  [[nodiscard]] Status start();
  /// Waits for a frame; nothing after `timeout`, when `stop` is requested, or when control was lost. The
  /// frame is valid until the next call.
  [[nodiscard]] std::optional<RawFrame> receive(const std::stop_token& stop, nanoseconds timeout);
  /// The camera no longer obeys (it was restarted, or somebody else has it): open it anew.
  [[nodiscard]] bool control_lost() const;

  [[nodiscard]] const CameraAbilities& abilities() const;
  [[nodiscard]] Result<PtpReading> read_ptp();
  /// The camera's clock and the moment it was read, the middle of the question's round trip.
  struct ClockReading {
    SensorTime device{};
    HostTime host{};
    nanoseconds round_trip{};
  };
  [[nodiscard]] Result<ClockReading> read_clock();
  [[nodiscard]] StreamStatistics statistics() const;
  [[nodiscard]] int packet_bytes() const;
  /// "edgesplat VirtualCamera ES-7F000001 at 127.0.0.1".
  [[nodiscard]] const std::string& name() const;
  /// IPv4, to see whether it is still there.
  [[nodiscard]] const std::string& address() const;

 private:
  class Device;
  explicit AravisCamera(std::unique_ptr<Device> device);
  std::unique_ptr<Device> device_;
};

/// This build can open GigE Vision cameras.
[[nodiscard]] bool has_aravis();

}  // namespace edgesplat::aravis
