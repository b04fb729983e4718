// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/aravis/camera_config.hpp"
#include "robot/drivers/aravis/feature_access.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace edgesplat::aravis {

/// Per-frame values that the camera appends to a picture.
enum class Chunk : std::uint8_t { kTimestamp, kExposureTime, kGain, kFrameId, kCounter };

/// What the camera turned out to have, by the names it has them under; an empty name: not at all.
struct CameraAbilities {
  std::string ptp_enable;
  std::string ptp_latch;
  std::string ptp_status;
  std::string ptp_offset;
  std::string clock_latch;
  std::string clock_value;
  std::string exposure;
  std::string gain;
  std::vector<Chunk> chunks;
  /// Settings that the camera refused or does not have, with the reason; it works without them.
  std::vector<std::string> without;

  [[nodiscard]] bool has_ptp() const { return !ptp_status.empty(); }
  [[nodiscard]] bool has(Chunk chunk) const;
};

/// Sets everything before the acquisition, in the order of ../shared/design/sensor-protocols.md 3.2: clock,
/// pixel format, trigger, exposure and gain, chunks. Standard names first, then those of older cameras.
/// Errors: settings without which pictures would be wrong (pixel format, trigger, exposure).
[[nodiscard]] Result<CameraAbilities> set_up_camera(FeatureAccess& features, const GigeCameraConfig& config);

struct PtpReading {
  std::string status;  ///< "Slave": disciplined by a master
  std::optional<std::int64_t> offset_ns;
  [[nodiscard]] bool is_slave() const { return status == "Slave"; }
};
/// Precondition: abilities.has_ptp().
[[nodiscard]] Result<PtpReading> read_ptp(FeatureAccess& features, const CameraAbilities& abilities);
/// What the camera's clock shows now, in its ticks. kNotFound where it cannot be asked.
[[nodiscard]] Result<std::int64_t> read_clock_ticks(FeatureAccess& features,
                                                    const CameraAbilities& abilities);

}  // namespace edgesplat::aravis
