// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/image.hpp"
#include "common/time/time.hpp"
#include "tools/virtual_device/gige_gvcp.hpp"
#include "tools/virtual_device/gige_gvsp.hpp"
#include "tools/virtual_device/gige_registers.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace edgesplat::virtual_device {

/// Where a datagram comes from or goes to, in host order.
struct GigePeer {
  std::uint32_t address = 0;
  std::uint16_t port = 0;
  friend bool operator==(const GigePeer&, const GigePeer&) = default;
};

/// What the sensor saw at one pulse of the trigger line.
struct GigeExposure {
  std::shared_ptr<const sensor::ImageRgb8> image;  ///< of the model's size
  SensorTime start{};                              ///< of the exposure, device clock
  float exposure_us = 0.0F;
  float gain_db = 0.0F;
};

/// The camera without its sockets: commands in, answers and frames out. Sends a frame for each pulse on Line0
/// (or freely, as exposures come) while it is told to, and on TriggerSoftware; keeps the newest frames for
/// resends. A host that falls silent for the heartbeat timeout loses control. Single-owner, no clock of its
/// own.
class GigeDevice {
 public:
  explicit GigeDevice(const GigeCameraModel& model);

  /// The answer to one GVCP datagram, empty where none is due.
  [[nodiscard]] std::vector<std::byte> on_datagram(std::span<const std::byte> datagram, GigePeer from,
                                                   HostTime now);
  /// A pulse on the trigger line, counted whether a frame comes of it or not.
  [[nodiscard]] std::shared_ptr<const GvspFrame> expose(const GigeExposure& exposure);
  /// A pulse that the camera misses, as when it is still busy: counted, no frame, no frame number.
  void miss_pulse() { ++pulses_; }
  /// The heartbeat.
  void tick(HostTime now);
  /// Power off and on: all settings, numbers and the host's control are gone.
  void reboot();

  /// What the camera's clock shows at a moment of the host's; without it the host's own time.
  using DeviceTime = std::function<SensorTime(HostTime)>;
  void set_clock(DeviceTime clock) { clock_ = std::move(clock); }
  /// PTP: a master is heard; how far the servo is off it.
  void set_ptp(bool master_present, std::int64_t offset_ns);

  // What commands set off; each is given once.
  [[nodiscard]] std::optional<std::uint32_t> take_test_packet_bytes();
  [[nodiscard]] std::optional<GvcpPacketResend> take_resend();
  [[nodiscard]] std::shared_ptr<const GvspFrame> take_triggered_frame();

  /// The frame while it is kept.
  [[nodiscard]] std::shared_ptr<const GvspFrame> find_frame(std::uint64_t number) const;
  /// Of the stream; nothing where no host listens.
  [[nodiscard]] std::optional<GigePeer> stream_to() const;
  [[nodiscard]] bool acquiring() const { return acquiring_; }
  [[nodiscard]] bool controlled() const { return controller_.has_value(); }
  [[nodiscard]] const GigeRegisters& registers() const { return registers_; }
  [[nodiscard]] std::uint64_t control_losses() const { return control_losses_; }

 private:
  using Answer = std::vector<std::byte>;
  [[nodiscard]] Answer answer(const GvcpCommand& command, GigePeer from, HostTime now);
  [[nodiscard]] Answer read_registers(const GvcpCommand& command, const GvcpReadRegister& read);
  [[nodiscard]] Answer write_registers(const GvcpCommand& command, const GvcpWriteRegister& write,
                                       GigePeer from, HostTime now);
  [[nodiscard]] Answer write_memory(const GvcpCommand& command, const GvcpWriteMemory& write, GigePeer from,
                                    HostTime now);
  [[nodiscard]] std::optional<GvcpStatus> write_one(std::uint32_t address, std::uint32_t value, GigePeer from,
                                                    HostTime now);
  [[nodiscard]] std::optional<GvcpStatus> change_control(std::uint32_t value, GigePeer from, HostTime now);
  void after_write(std::uint32_t address, HostTime now);
  void update_payload_bytes();
  void update_ptp();
  void lose_control();
  [[nodiscard]] bool wants_pulses() const;
  [[nodiscard]] std::uint64_t device_ticks(HostTime now) const;
  [[nodiscard]] std::shared_ptr<const GvspFrame> make_frame(const GigeExposure& exposure);
  void append_chunks(GvspFrame& frame, const GigeExposure& exposure) const;
  [[nodiscard]] bool chunk_enabled(GigeChunk chunk) const;

  GigeCameraModel model_;
  GigeRegisters registers_;
  std::optional<GigePeer> controller_;
  HostTime heard_{};
  bool acquiring_ = false;
  std::uint16_t frame_number_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t pulses_ = 0;
  std::deque<std::shared_ptr<const GvspFrame>> kept_;
  std::optional<GigeExposure> scene_;
  DeviceTime clock_;
  bool ptp_master_ = false;
  std::int64_t ptp_offset_ns_ = 0;
  std::optional<std::uint32_t> test_packet_bytes_;
  std::deque<GvcpPacketResend> resends_;
  std::shared_ptr<const GvspFrame> triggered_;
  std::uint64_t control_losses_ = 0;
};

}  // namespace edgesplat::virtual_device
