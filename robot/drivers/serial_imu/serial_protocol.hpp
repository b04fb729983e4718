// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

namespace edgesplat::serial_imu {

/// What an inertial sensor, or the microcontroller that makes trigger pulses, sends over a serial line.
/// Little-endian:
///
/// | offset | field |
/// |---|---|
/// | 0 | u8 0xA5, u8 0x5A |
/// | 2 | u8 type: 1 inertial sample, 2 trigger pulse |
/// | 3 | u8 payload bytes |
/// | 4 | u16 sequence, +1 a frame of this type |
/// | 6 | payload |
/// | 6 + payload | u16 CRC-16/CCITT-FALSE (0x1021, begins with 0xFFFF) of everything from the type to the
/// payload |
///
/// Inertial sample (32 bytes): i64 the sensor's clock in ns | f32 x 3 gyroscope, rad/s | f32 x 3 specific
/// force, m/s2. Trigger pulse (16 bytes): u32 number, +1 a pulse | u32 0 | i64 time of its edge in ns of Unix
/// time, from the PPS.
inline constexpr std::size_t kHeaderBytes = 6;
inline constexpr std::size_t kChecksumBytes = 2;
inline constexpr std::size_t kSampleBytes = 32;
inline constexpr std::size_t kPulseBytes = 16;

struct InertialFrame {
  std::uint16_t sequence = 0;
  SensorTime stamp{};
  Eigen::Vector3f gyro_radps = Eigen::Vector3f::Zero();
  Eigen::Vector3f accel_mps2 = Eigen::Vector3f::Zero();
};
struct PulseFrame {
  std::uint16_t sequence = 0;
  std::uint32_t number = 0;
  std::int64_t edge_ns = 0;
};
using Frame = std::variant<InertialFrame, PulseFrame>;

[[nodiscard]] std::uint16_t crc16_ccitt(std::span<const std::byte> bytes);
[[nodiscard]] std::vector<std::byte> encode(const InertialFrame& frame);
[[nodiscard]] std::vector<std::byte> encode(const PulseFrame& frame);

struct DecoderCounters {
  std::uint64_t bad_checksums = 0;
  std::uint64_t unknown = 0;        ///< right checksum, but no type and length that are known
  std::uint64_t bytes_skipped = 0;  ///< that belong to no frame
};

/// Cuts a byte stream into frames: partial reads, noise between frames, resynchronisation on the next 0xA5
/// 0x5A. Memory for one frame and one read. Single-owner.
class FrameDecoder {
 public:
  void append(std::span<const std::byte> bytes);
  [[nodiscard]] std::optional<Frame> next();
  /// The line is new: forget the rest of the old one.
  void restart() { waiting_.clear(); }
  [[nodiscard]] const DecoderCounters& counters() const { return counters_; }

 private:
  void skip(std::size_t bytes);

  std::vector<std::byte> waiting_;
  DecoderCounters counters_;
};

}  // namespace edgesplat::serial_imu
