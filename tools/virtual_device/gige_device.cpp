// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/gige_device.hpp"

#include "common/base/check.hpp"
#include "tools/virtual_device/big_endian.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>

namespace edgesplat::virtual_device {
namespace {

namespace reg = gige_register;

constexpr std::size_t kKeptFrames = 4;
constexpr std::size_t kWaitingResends = 64;
constexpr std::uint32_t kChunkTailBytes = 8;
constexpr std::uint32_t kChunkValueBytes = 8;
constexpr std::uint32_t kControlBits = 0x3;

}  // namespace

GigeDevice::GigeDevice(const GigeCameraModel& model) : model_(model), registers_(model) {
  update_payload_bytes();
}

void GigeDevice::reboot() {
  const bool master = ptp_master_;
  const std::uint64_t losses = control_losses_ + (controller_ ? 1 : 0);
  DeviceTime clock = std::move(clock_);
  *this = GigeDevice(model_);
  clock_ = std::move(clock);
  ptp_master_ = master;
  control_losses_ = losses;
}

GigeDevice::Answer GigeDevice::on_datagram(std::span<const std::byte> datagram, GigePeer from, HostTime now) {
  const GvcpDecoded decoded = decode_gvcp(datagram);
  if (const auto* fault = std::get_if<GvcpFault>(&decoded)) return fault->answer.value_or(Answer{});
  const auto& command = std::get<GvcpCommand>(decoded);
  if (controller_ == from) heard_ = now;
  Answer reply = answer(command, from, now);
  return command.wants_answer ? reply : Answer{};
}

GigeDevice::Answer GigeDevice::answer(const GvcpCommand& command, GigePeer from, HostTime now) {
  return std::visit(
      [&](const auto& what) -> Answer {
        using T = std::decay_t<decltype(what)>;
        if constexpr (std::is_same_v<T, GvcpDiscovery>) {
          return gvcp_discovery_ack(command.id, registers_.discovery_data());
        } else if constexpr (std::is_same_v<T, GvcpReadRegister>) {
          return read_registers(command, what);
        } else if constexpr (std::is_same_v<T, GvcpWriteRegister>) {
          return write_registers(command, what, from, now);
        } else if constexpr (std::is_same_v<T, GvcpReadMemory>) {
          const auto bytes = registers_.read(what.address, what.count_bytes);
          if (!bytes) return gvcp_error(command, GvcpStatus::kInvalidAddress);
          return gvcp_read_memory_ack(command.id, what.address, *bytes);
        } else if constexpr (std::is_same_v<T, GvcpWriteMemory>) {
          return write_memory(command, what, from, now);
        } else {
          if (resends_.size() < kWaitingResends) resends_.push_back(what);
          return {};
        }
      },
      command.what);
}

GigeDevice::Answer GigeDevice::read_registers(const GvcpCommand& command, const GvcpReadRegister& read) {
  std::vector<std::uint32_t> values;
  for (const std::uint32_t address : read.addresses) {
    if (address % 4 != 0) return gvcp_error(command, GvcpStatus::kBadAlignment);
    if (!registers_.read(address, 4)) return gvcp_error(command, GvcpStatus::kInvalidAddress);
    values.push_back(registers_.value(address));
  }
  return gvcp_read_register_ack(command.id, values);
}

GigeDevice::Answer GigeDevice::write_registers(const GvcpCommand& command, const GvcpWriteRegister& write,
                                               GigePeer from, HostTime now) {
  std::uint16_t done = 0;
  for (const auto& [address, value] : write.writes) {
    if (const auto error = write_one(address, value, from, now)) return gvcp_error(command, *error);
    ++done;
  }
  return gvcp_write_register_ack(command.id, done);
}

GigeDevice::Answer GigeDevice::write_memory(const GvcpCommand& command, const GvcpWriteMemory& write,
                                            GigePeer from, HostTime now) {
  if (write.data.size() % 4 != 0) return gvcp_error(command, GvcpStatus::kBadAlignment);
  ByteReader in(write.data);
  for (std::uint32_t at = 0; in.remaining() > 0; at += 4) {
    const auto error = write_one(write.address + at, read_be32(in), from, now);
    if (error) return gvcp_error(command, *error);
  }
  return gvcp_write_memory_ack(command.id, static_cast<std::uint16_t>(write.data.size()));
}

std::optional<GvcpStatus> GigeDevice::write_one(std::uint32_t address, std::uint32_t value, GigePeer from,
                                                HostTime now) {
  if (address == GigeRegisters::kControlPrivilege) return change_control(value, from, now);
  if (controller_ != from) return GvcpStatus::kAccessDenied;
  if (const auto error = registers_.write(address, value)) return error;
  after_write(address, now);
  return std::nullopt;
}

std::optional<GvcpStatus> GigeDevice::change_control(std::uint32_t value, GigePeer from, HostTime now) {
  if (controller_ && controller_ != from) return GvcpStatus::kAccessDenied;
  if ((value & kControlBits) == 0) {
    lose_control();
    return std::nullopt;
  }
  controller_ = from;
  heard_ = now;
  registers_.set(GigeRegisters::kControlPrivilege, value & kControlBits);
  return std::nullopt;
}

void GigeDevice::lose_control() {
  controller_.reset();
  acquiring_ = false;
  registers_.set(GigeRegisters::kControlPrivilege, 0);
  registers_.set(GigeRegisters::kStreamPort, 0);
}

void GigeDevice::tick(HostTime now) {
  if (!controller_) return;
  const auto patience = std::chrono::milliseconds(registers_.value(GigeRegisters::kHeartbeatTimeout));
  if (now - heard_ <= patience) return;
  ++control_losses_;
  lose_control();
}

void GigeDevice::after_write(std::uint32_t address, HostTime now) {
  const std::uint32_t value = registers_.value(address);
  switch (address) {
    case GigeRegisters::kPacketSize:
      if ((value & GigeRegisters::kFireTestPacket) != 0) {
        test_packet_bytes_ = registers_.packet_bytes();
        registers_.set(address, value & ~GigeRegisters::kFireTestPacket);
      }
      break;
    case GigeRegisters::kTimestampControl:  // bit 1 (from the lowest): latch
      registers_.set64(GigeRegisters::kTimestampLatched, device_ticks(now));
      break;
    case reg::kTimestampLatch:
      registers_.set64(reg::kTimestampLatchValue, device_ticks(now));
      break;
    case reg::kAcquisitionStart:
      acquiring_ = true;
      pulses_ = 0;
      break;
    case reg::kAcquisitionStop:
      acquiring_ = false;
      break;
    case reg::kTriggerSoftware: {
      const bool software =
          registers_.value(reg::kTriggerSource) == static_cast<std::uint32_t>(GigeTriggerSource::kSoftware);
      if (acquiring_ && software && registers_.value(reg::kTriggerMode) == 1 && scene_) {
        scene_->start = sensor_time_from_ns(static_cast<std::int64_t>(device_ticks(now)));
        triggered_ = make_frame(*scene_);
      }
      break;
    }
    case reg::kPtpEnable:
    case reg::kPtpDataSetLatch:
      update_ptp();
      break;
    default:
      update_payload_bytes();
  }
}

void GigeDevice::set_ptp(bool master_present, std::int64_t offset_ns) {
  ptp_master_ = master_present;
  ptp_offset_ns_ = offset_ns;
}

void GigeDevice::update_ptp() {
  GigePtpState state = GigePtpState::kDisabled;
  if (registers_.value(reg::kPtpEnable) == 1)
    state = ptp_master_ ? GigePtpState::kSlave : GigePtpState::kListening;
  registers_.set(reg::kPtpStatus, static_cast<std::uint32_t>(state));
  registers_.set64(reg::kPtpOffset, static_cast<std::uint64_t>(ptp_offset_ns_));
}

std::uint64_t GigeDevice::device_ticks(HostTime now) const {
  return static_cast<std::uint64_t>(clock_ ? to_ns(clock_(now)) : to_ns(now));
}

bool GigeDevice::chunk_enabled(GigeChunk chunk) const {
  return registers_.value(reg::kChunkModeActive) == 1 &&
         registers_.value(reg::kChunkEnable + 4 * static_cast<std::uint32_t>(chunk)) == 1;
}

void GigeDevice::update_payload_bytes() {
  std::uint32_t bytes = model_.width_px * model_.height_px *
                        static_cast<std::uint32_t>(bytes_per_pixel(registers_.pixel_format()));
  if (registers_.value(reg::kChunkModeActive) == 1) bytes += kChunkTailBytes;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(GigeChunk::kCount); ++i)
    if (chunk_enabled(static_cast<GigeChunk>(i))) bytes += kChunkValueBytes + kChunkTailBytes;
  registers_.set(reg::kPayloadBytes, bytes);
}

bool GigeDevice::wants_pulses() const {
  if (!acquiring_ || !stream_to()) return false;
  if (registers_.value(reg::kTriggerMode) == 0) return true;
  return registers_.value(reg::kTriggerSource) == static_cast<std::uint32_t>(GigeTriggerSource::kLine0);
}

std::shared_ptr<const GvspFrame> GigeDevice::expose(const GigeExposure& exposure) {
  EDGESPLAT_CHECK(exposure.image->width_px == static_cast<int>(model_.width_px) &&
                      exposure.image->height_px == static_cast<int>(model_.height_px),
                  "a picture of the sensor's size");
  scene_ = exposure;
  ++pulses_;
  return wants_pulses() ? make_frame(exposure) : nullptr;
}

std::shared_ptr<const GvspFrame> GigeDevice::make_frame(const GigeExposure& exposure) {
  auto frame = std::make_shared<GvspFrame>();
  frame_number_ = frame_number_ == 0xFFFF ? 1 : static_cast<std::uint16_t>(frame_number_ + 1);
  ++frames_;
  frame->number = frame_number_;
  frame->stamp_ticks = static_cast<std::uint64_t>(to_ns(exposure.start));
  frame->format = registers_.pixel_format();
  frame->width_px = model_.width_px;
  frame->height_px = model_.height_px;
  frame->has_chunks = registers_.value(reg::kChunkModeActive) == 1;
  frame->payload = encode_pixels(*exposure.image, frame->format);
  if (frame->has_chunks) append_chunks(*frame, exposure);
  kept_.push_back(frame);
  while (kept_.size() > kKeptFrames) kept_.pop_front();
  return frame;
}

void GigeDevice::append_chunks(GvspFrame& frame, const GigeExposure& exposure) const {
  end_chunk(frame.payload, kImageChunkId, static_cast<std::uint32_t>(frame.payload.size()));
  const auto append = [&](GigeChunk chunk, std::uint64_t value) {
    if (!chunk_enabled(chunk)) return;
    ByteWriter bytes;
    write_be64(bytes, value);
    frame.payload.insert(frame.payload.end(), bytes.bytes().begin(), bytes.bytes().end());
    end_chunk(frame.payload, chunk_id(chunk), kChunkValueBytes);
  };
  append(GigeChunk::kTimestamp, frame.stamp_ticks);
  append(GigeChunk::kExposureTime, std::bit_cast<std::uint64_t>(static_cast<double>(exposure.exposure_us)));
  append(GigeChunk::kGain, std::bit_cast<std::uint64_t>(static_cast<double>(exposure.gain_db)));
  append(GigeChunk::kFrameId, frames_);
  append(GigeChunk::kCounterValue, pulses_);
}

std::optional<std::uint32_t> GigeDevice::take_test_packet_bytes() {
  return std::exchange(test_packet_bytes_, std::nullopt);
}

std::optional<GvcpPacketResend> GigeDevice::take_resend() {
  if (resends_.empty()) return std::nullopt;
  const GvcpPacketResend next = resends_.front();
  resends_.pop_front();
  return next;
}

std::shared_ptr<const GvspFrame> GigeDevice::take_triggered_frame() {
  return std::exchange(triggered_, nullptr);
}

std::shared_ptr<const GvspFrame> GigeDevice::find_frame(std::uint64_t number) const {
  const auto found =
      std::ranges::find_if(kept_, [number](const auto& frame) { return frame->number == number; });
  return found == kept_.end() ? nullptr : *found;
}

std::optional<GigePeer> GigeDevice::stream_to() const {
  const auto port = static_cast<std::uint16_t>(registers_.value(GigeRegisters::kStreamPort) & 0xFFFFU);
  const std::uint32_t address = registers_.value(GigeRegisters::kStreamAddress);
  if (port == 0 || address == 0) return std::nullopt;
  return GigePeer{address, port};
}

}  // namespace edgesplat::virtual_device
