// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/base/unique_fd.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"
#include "common/time/clock.hpp"
#include "tools/virtual_device/gige_device.hpp"
#include "tools/virtual_device/gige_sockets.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

namespace edgesplat::virtual_device {

struct GigeServerOptions {
  std::string address = "127.0.0.1";  ///< IPv4 of this machine; the camera answers on its UDP port 3956
  GigeCameraModel model;  ///< its address_ipv4 is set from `address`, and its serial number where it has none
  std::uint32_t path_bytes = 9000;  ///< larger packets do not get through, [256, 9000]
  double link_bytes_per_s = 117e6;  ///< frames are paced to this: Gigabit Ethernet
  std::uint64_t seed = 1;           ///< of the losses on demand
};

/// What is wrong with the camera at present.
struct GigeFaults {
  double loss = 0.0;       ///< share of packets lost, both ways
  bool silent = false;     ///< unplugged: nothing gets in or out
  bool half_open = false;  ///< answers commands, sends no frames
  double held_up_s = 0.0;  ///< in the middle of each frame: a switch that is busy with others
};

struct GigeServerCounters {
  std::uint64_t frames_sent = 0;
  std::uint64_t frames_unsent = 0;  ///< nobody listens, not triggered, a fault, or the link too slow
  std::uint64_t packets_sent = 0;   ///< resends not counted
  std::uint64_t packets_lost = 0;   ///< on demand
  std::uint64_t packets_resent = 0;
  std::uint64_t packets_unavailable = 0;  ///< asked for after the frame was forgotten
  std::uint64_t packets_refused = 0;      ///< by the system
  std::uint64_t control_losses = 0;
};

/// A GigeDevice on the network: a thread answers commands and resends, another sends frames at the pace of
/// the link. Thread-safe.
class GigeServer {
 public:
  /// kInvalidConfig for a bad address, kIo where the port is taken.
  static Result<std::unique_ptr<GigeServer>> open(const GigeServerOptions& options, const Clock& clock);
  ~GigeServer();
  GigeServer(const GigeServer&) = delete;
  GigeServer& operator=(const GigeServer&) = delete;

  /// Until a host has started the acquisition. False when nobody did in time, or a stop was requested.
  bool wait_for_robot(std::chrono::milliseconds timeout, const std::stop_token& stop);
  /// A pulse on the trigger line; the frame goes out on the other thread. When that does not keep up, the
  /// oldest waiting exposure is dropped and counted as unsent.
  void push(GigeExposure exposure);
  /// A pulse that the camera misses: it counts it but has no frame.
  void miss_pulse();
  /// Sends what waits, then the camera is gone.
  void finish();

  void set_faults(const GigeFaults& faults);
  void set_clock(GigeDevice::DeviceTime clock);
  void set_ptp(bool master_present, std::int64_t offset_ns = 0);
  void reboot();

  [[nodiscard]] const GigeCameraModel& model() const { return options_.model; }
  [[nodiscard]] GigeServerCounters counters() const;

 private:
  GigeServer(const GigeServerOptions& options, GigeSockets sockets, const Clock& clock);
  void linger();
  bool control_step(const std::stop_token& stop);
  void take_command(const UniqueFd& socket);
  void on_command(std::span<const std::byte> datagram, GigePeer from);
  void serve_effects();
  void send_test_packet(std::uint32_t bytes);
  void resend(const GvcpPacketResend& wanted);
  void send_frame(const GigeExposure& exposure);
  void stream_frame(const GvspFrame& frame, GigePeer to, std::uint32_t packet_bytes);
  [[nodiscard]] GigeFaults faults() const;
  [[nodiscard]] bool wire_loses(double share);
  bool send(const UniqueFd& socket, std::span<const std::byte> packet, GigePeer to);

  GigeServerOptions options_;
  GigeSockets sockets_;
  const Clock& clock_;
  mutable std::mutex mutex_;  ///< of device_, faults_ and acquiring_
  std::condition_variable_any acquiring_changed_;
  GigeDevice device_;
  GigeFaults faults_;
  std::atomic<std::uint64_t> draws_{0};
  std::atomic<std::uint64_t> frames_sent_{0}, frames_unsent_{0}, packets_sent_{0}, packets_lost_{0},
      packets_resent_{0}, packets_unavailable_{0}, packets_refused_{0};
  thread::BoundedQueue<GigeExposure> queue_;
  std::optional<thread::Worker> control_worker_;
  std::optional<thread::Worker> stream_worker_;
};

}  // namespace edgesplat::virtual_device
