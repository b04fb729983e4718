// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/virtual_device/gige_registers.hpp"

#include "common/base/check.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>

namespace edgesplat::virtual_device {
namespace {

namespace reg = gige_register;

constexpr std::uint32_t kDescriptionAt = 0x2'0000;
constexpr std::uint32_t kTicksPerSecond = 1'000'000'000;
constexpr std::uint32_t kDefaultHeartbeat_ms = 3000;
constexpr std::uint32_t kResendAndMemory = 0x6;  // GVCP capabilities: write memory, packet resend

struct Extent {
  std::uint32_t begin;
  std::uint32_t end;
};
constexpr std::array<Extent, 11> kWritable{
    Extent{GigeRegisters::kHeartbeatTimeout, 0x93C}, Extent{GigeRegisters::kTimestampControl, 0x948},
    Extent{GigeRegisters::kControlPrivilege, 0xA04}, Extent{GigeRegisters::kStreamPort, 0xD0C},
    Extent{GigeRegisters::kStreamAddress, 0xD1C},    Extent{reg::kPixelFormat, reg::kPayloadBytes},
    Extent{reg::kAcquisitionStart, 0x1'003C},        Extent{reg::kTriggerMode, 0x1'0080},
    Extent{reg::kChunkModeActive, 0x1'0098},         Extent{reg::kPtpEnable, reg::kPtpStatus},
    Extent{reg::kTimestampLatch, 0x1'00BC}};

void store_be32(std::byte* at, std::uint32_t value) {
  const std::uint32_t swapped = __builtin_bswap32(value);
  std::memcpy(at, &swapped, sizeof(swapped));
}

}  // namespace

GigeRegisters::GigeRegisters(const GigeCameraModel& model) {
  const std::string description = gige_description(model.vocabulary, model.width_px, model.height_px);
  memory_.resize(kDescriptionAt + description.size());
  std::memcpy(memory_.data() + kDescriptionAt, description.data(), description.size());
  set(0x0, 0x0002'0000);  // GigE Vision 2.0
  set(0x4, 0x8000'0001);  // big-endian, UTF-8
  set(0x8, 0x0000'0245);  // a locally administered MAC address
  set(0xC, 0x4753'0000 + (model.address_ipv4 & 0xFFFFU));
  set(0x24, model.address_ipv4);
  set(0x34, 0xFF00'0000);
  set_text(0x48, "edgesplat");
  set_text(0x68, "VirtualCamera");
  set_text(0x88, "1.0");
  set_text(0xA8, "plays a recording");
  set_text(0xD8, std::string_view(model.serial).substr(0, 15));
  char url[64];
  std::snprintf(url, sizeof(url), "Local:virtual_camera.xml;%X;%zX", kDescriptionAt, description.size());
  set_text(0x200, url);
  set(0x600, 1);  // network interfaces
  set(0x904, 1);  // stream channels
  set(0x934, kResendAndMemory);
  set(kHeartbeatTimeout, kDefaultHeartbeat_ms);
  set(0x940, kTicksPerSecond);
  set(kPacketSize, 1500);
  set(reg::kWidth, model.width_px);
  set(reg::kHeight, model.height_px);
  set(reg::kPixelFormat, static_cast<std::uint32_t>(GigePixelFormat::kMono8));
  set(reg::kPtpStatus, static_cast<std::uint32_t>(GigePtpState::kDisabled));
  set(reg::kExposureTime, std::bit_cast<std::uint32_t>(5000.0F));
  set(reg::kFrameRate, std::bit_cast<std::uint32_t>(10.0F));
}

void GigeRegisters::set_text(std::uint32_t address, std::string_view text) {
  std::memcpy(memory_.data() + address, text.data(), text.size());
}

std::optional<std::span<const std::byte>> GigeRegisters::read(std::uint32_t address,
                                                              std::size_t count) const {
  if (address > memory_.size()) return std::nullopt;
  if (count > memory_.size() - address) return std::nullopt;
  return std::span(memory_).subspan(address, count);
}

bool GigeRegisters::writable(std::uint32_t address, std::size_t count) const {
  return std::ranges::any_of(kWritable, [&](const Extent& extent) {
    return address >= extent.begin && address < extent.end && count <= extent.end - address;
  });
}

/// Settings that the camera refuses.
bool GigeRegisters::acceptable(std::uint32_t address, std::uint32_t value) const {
  if (address == reg::kPixelFormat) return is_pixel_format(value);
  if (address == kPacketSize) {
    const std::uint32_t bytes = value & 0xFFFFU;
    return bytes >= kMinPacketBytes && bytes <= kMaxPacketBytes;
  }
  if (address == reg::kExposureTime) {
    const auto microseconds = std::bit_cast<float>(value);
    return microseconds >= 10.0F && microseconds <= 1e6F;
  }
  return true;
}

std::optional<GvcpStatus> GigeRegisters::write(std::uint32_t address, std::span<const std::byte> bytes) {
  if (address > memory_.size() || bytes.size() > memory_.size() - address) return GvcpStatus::kInvalidAddress;
  if (!writable(address, bytes.size())) return GvcpStatus::kWriteProtect;
  if (address % 4 != 0 || bytes.size() % 4 != 0) return GvcpStatus::kBadAlignment;
  for (std::size_t at = 0; at < bytes.size(); at += 4) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    value = __builtin_bswap32(value);
    if (!acceptable(address + static_cast<std::uint32_t>(at), value)) return GvcpStatus::kInvalidParameter;
  }
  std::ranges::copy(bytes, memory_.begin() + address);
  return std::nullopt;
}

std::optional<GvcpStatus> GigeRegisters::write(std::uint32_t address, std::uint32_t value) {
  std::array<std::byte, 4> bytes{};
  store_be32(bytes.data(), value);
  return write(address, bytes);
}

std::uint32_t GigeRegisters::value(std::uint32_t address) const {
  EDGESPLAT_CHECK(address + 4 <= memory_.size(), "a register of the camera");
  std::uint32_t value = 0;
  std::memcpy(&value, memory_.data() + address, sizeof(value));
  return __builtin_bswap32(value);
}

float GigeRegisters::number(std::uint32_t address) const {
  return std::bit_cast<float>(value(address));
}

void GigeRegisters::set(std::uint32_t address, std::uint32_t value) {
  EDGESPLAT_CHECK(address + 4 <= memory_.size(), "a register of the camera");
  store_be32(memory_.data() + address, value);
}

void GigeRegisters::set64(std::uint32_t address, std::uint64_t value) {
  set(address, static_cast<std::uint32_t>(value >> 32U));
  set(address + 4, static_cast<std::uint32_t>(value));
}

}  // namespace edgesplat::virtual_device
