// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "tools/simulate/device_clock.hpp"
#include "tools/simulate/recording_writer.hpp"
#include "tools/simulate/simulate_options.hpp"
#include "tools/simulate/trajectory.hpp"

namespace edgesplat::simulate {

inline constexpr double kFramePeriod_s = 0.1;

/// The camera of a simulation: frame k is exposed around 0.05 s + k * 0.1 s. Renders on all cores.
/// Single-owner.
class VirtualCamera {
 public:
  VirtualCamera(const World& world, const Trajectory& trajectory, const SimulateOptions& options);
  /// The next frame, encoded, with its truth.
  Result<RecordedFrame> expose();

 private:
  const World& world_;
  const Trajectory& trajectory_;
  sensor::CameraMount mount_;
  CameraSensor sensor_;
  DeviceClock clock_;
  ArrivalModel arrival_;
  std::uint32_t next_ = 0;
};

/// What an ideal camera sees of the static world at the exposure of a recording's start: no movers, no
/// vignetting, no noise. What a map is judged by.
[[nodiscard]] sensor::ImageRgb8 clean_picture(const World& world, const geometry::CameraModel& camera,
                                              const geometry::RigidTransform& world_from_camera);

/// Writes options.clean_views: the static world, ideally exposed, from each pose of the file.
[[nodiscard]] Status write_clean_views(const World& world, const SimulateOptions& options);

}  // namespace edgesplat::simulate
