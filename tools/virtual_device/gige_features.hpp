// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace edgesplat::virtual_device {

/// Where the virtual camera keeps what its features stand for, beyond the bootstrap registers.
namespace gige_register {
inline constexpr std::uint32_t kWidth = 0x1'0000;
inline constexpr std::uint32_t kHeight = 0x1'0004;
inline constexpr std::uint32_t kPixelFormat = 0x1'0008;
inline constexpr std::uint32_t kPayloadBytes = 0x1'000C;
inline constexpr std::uint32_t kAcquisitionStart = 0x1'0010;
inline constexpr std::uint32_t kAcquisitionStop = 0x1'0014;
inline constexpr std::uint32_t kAcquisitionMode = 0x1'0018;
inline constexpr std::uint32_t kFrameRateEnable = 0x1'001C;
inline constexpr std::uint32_t kFrameRate = 0x1'0020;        ///< float32, Hz
inline constexpr std::uint32_t kExposureTime = 0x1'0024;     ///< float32, us
inline constexpr std::uint32_t kExposureAuto = 0x1'0028;     ///< 0 off, 1 continuous
inline constexpr std::uint32_t kGain = 0x1'002C;             ///< float32 dB, or raw counts of 0.1 dB
inline constexpr std::uint32_t kGainAuto = 0x1'0030;         ///< 0 off, 1 continuous
inline constexpr std::uint32_t kTriggerSoftware = 0x1'0034;  ///< command
inline constexpr std::uint32_t kTriggerDelay = 0x1'0038;     ///< float32, us
inline constexpr std::uint32_t kTriggerMode = 0x1'0040;      ///< + 0x20 for each selector
inline constexpr std::uint32_t kTriggerSource = 0x1'0044;
inline constexpr std::uint32_t kTriggerActivation = 0x1'0048;
inline constexpr std::uint32_t kChunkModeActive = 0x1'0080;
inline constexpr std::uint32_t kChunkEnable = 0x1'0084;  ///< + 4 for each selector
inline constexpr std::uint32_t kPtpEnable = 0x1'00A0;
inline constexpr std::uint32_t kPtpDataSetLatch = 0x1'00A4;
inline constexpr std::uint32_t kPtpStatus = 0x1'00A8;            ///< PtpState
inline constexpr std::uint32_t kPtpOffset = 0x1'00B0;            ///< int64 ns, from master
inline constexpr std::uint32_t kTimestampLatch = 0x1'00B8;       ///< command
inline constexpr std::uint32_t kTimestampLatchValue = 0x1'00C0;  ///< u64
inline constexpr std::uint32_t kEnd = 0x1'0100;
}  // namespace gige_register

enum class GigePtpState : std::uint32_t {
  kInitialising = 1,
  kListening = 4,
  kUncalibrated = 8,
  kSlave = 9,
  kDisabled = 3
};
enum class GigeTriggerSource : std::uint32_t { kLine0 = 0, kSoftware = 1 };

/// Chunks of a frame: their place among ChunkSelector and their id.
enum class GigeChunk : std::uint32_t { kTimestamp, kExposureTime, kGain, kFrameId, kCounterValue, kCount };
inline constexpr std::uint32_t kImageChunkId = 0xA000'0001;
[[nodiscard]] constexpr std::uint32_t chunk_id(GigeChunk chunk) {
  return 0xA000'0010 + static_cast<std::uint32_t>(chunk);
}

/// How a camera calls its features: today's standard names, or those of older cameras.
enum class GigeVocabulary : std::uint8_t {
  kSfnc,       ///< PtpEnable, ExposureTime, Gain, TimestampLatch
  kOlder,      ///< GevIEEE1588, ExposureTimeAbs, GainRaw, GevTimestampControlLatch
  kWithoutPtp  ///< standard names, but no PTP and no chunks
};

/// The GenICam description that the camera serves, schema 1.1.
[[nodiscard]] std::string gige_description(GigeVocabulary vocabulary, std::uint32_t sensor_width_px,
                                           std::uint32_t sensor_height_px);

}  // namespace edgesplat::virtual_device
