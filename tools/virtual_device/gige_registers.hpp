// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/virtual_device/gige_features.hpp"
#include "tools/virtual_device/gige_gvcp.hpp"
#include "tools/virtual_device/gige_gvsp.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace edgesplat::virtual_device {

/// What a virtual camera is.
struct GigeCameraModel {
  std::uint32_t width_px = 320;
  std::uint32_t height_px = 256;
  std::string serial;  ///< at most 15 characters
  GigeVocabulary vocabulary = GigeVocabulary::kSfnc;
  std::uint32_t address_ipv4 = 0x7F00'0001;  ///< what the bootstrap registers say, host order
};

/// The memory of a GigE Vision camera: bootstrap registers, those of its features, its description. Knows who
/// may write what, not what a write sets off. Single-owner.
class GigeRegisters {
 public:
  static constexpr std::uint32_t kControlPrivilege = 0xA00;
  static constexpr std::uint32_t kHeartbeatTimeout = 0x938;  ///< ms
  static constexpr std::uint32_t kStreamPort = 0xD00;        ///< of the host
  static constexpr std::uint32_t kPacketSize = 0xD04;        ///< and flags
  static constexpr std::uint32_t kFireTestPacket = 0x8000'0000;
  static constexpr std::uint32_t kStreamAddress = 0xD18;  ///< of the host
  static constexpr std::uint32_t kTimestampControl = 0x944;
  static constexpr std::uint32_t kTimestampLatched = 0x948;  ///< high, low
  static constexpr std::size_t kDiscoveryBytes = 0xF8;

  explicit GigeRegisters(const GigeCameraModel& model);

  /// Bytes for the host, or the error code it gets.
  [[nodiscard]] std::optional<std::span<const std::byte>> read(std::uint32_t address,
                                                               std::size_t count) const;
  /// Nothing where it was written.
  [[nodiscard]] std::optional<GvcpStatus> write(std::uint32_t address, std::span<const std::byte> bytes);
  [[nodiscard]] std::optional<GvcpStatus> write(std::uint32_t address, std::uint32_t value);

  /// The camera's own access. Precondition: the address exists.
  [[nodiscard]] std::uint32_t value(std::uint32_t address) const;
  [[nodiscard]] float number(std::uint32_t address) const;
  void set(std::uint32_t address, std::uint32_t value);
  void set64(std::uint32_t address, std::uint64_t value);
  [[nodiscard]] std::span<const std::byte> discovery_data() const {
    return std::span(memory_).first(kDiscoveryBytes);
  }
  [[nodiscard]] std::uint32_t packet_bytes() const { return value(kPacketSize) & 0xFFFFU; }
  [[nodiscard]] GigePixelFormat pixel_format() const {
    return static_cast<GigePixelFormat>(value(gige_register::kPixelFormat));
  }

 private:
  void set_text(std::uint32_t address, std::string_view text);
  [[nodiscard]] bool writable(std::uint32_t address, std::size_t count) const;
  [[nodiscard]] bool acceptable(std::uint32_t address, std::uint32_t value) const;

  std::vector<std::byte> memory_;
};

}  // namespace edgesplat::virtual_device
