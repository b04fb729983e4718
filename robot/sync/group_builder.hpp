// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/sensor/measurement.hpp"
#include "common/sensor/rig.hpp"
#include "common/time/clock_map.hpp"
#include "robot/sync/measure_group.hpp"
#include "robot/sync/time_base.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace edgesplat::sync {

struct GroupBuilderConfig {
  double period_s = 0.1;      ///< cut this often where no image tells when, [0.01, 1]
  double image_gap_s = 0.3;   ///< images further apart than this: periodic cuts in between, [0.05, 5]
  double image_wait_s = 0.1;  ///< how far an image may lag behind the points before it is missed, [0, 1]
  double sensor_gap_s = 0.5;  ///< a LiDAR or the IMU silent for this long: go on without it, [0.05, 5]
  double image_tolerance_s = 0.02;   ///< between a whole scan and its image, [0, 0.1]
  double disagree_limit_s = 0.5e-3;  ///< two disciplined clocks further apart: one of them lies, [1e-5, 0.1]
  bool imu_has_own_clock = false;    ///< it is not the LiDAR's
  std::size_t max_points = 1'000'000;  ///< of each LiDAR: 5 s of a Mid-360, 24 MB
  std::size_t max_imu_samples = 5'000;
  std::size_t max_images = 32;
  std::size_t max_image_bytes = std::size_t{128} << 20U;
  std::size_t max_scans = 8;
  ClockMapConfig clock;
};

/// What became of one LiDAR's points.
struct LidarCounters {
  std::uint64_t points = 0;  ///< that went into groups
  std::uint64_t outs = 0;    ///< times that it fell silent and groups went on without it
  bool is_out = false;       ///< now
};

/// Everything that did not go straight into a group.
struct GroupCounters {
  std::uint64_t groups = 0;
  std::uint64_t groups_without_image = 0;  ///< although the rig has a camera
  std::uint64_t groups_without_points = 0;
  std::uint64_t groups_without_imu = 0;  ///< although the rig has one: no sample at or after the end
  std::uint64_t late_points = 0;         ///< arrived after their group had left: dropped
  std::uint64_t clamped_points = 0;      ///< kept, moved to the group's begin: the clock relation was refined
  std::uint64_t overflow_points = 0;     ///< dropped, buffer full
  std::uint64_t late_imu = 0;
  std::uint64_t overflow_imu = 0;
  std::uint64_t late_images = 0;
  std::uint64_t overflow_images = 0;
  std::uint64_t unused_images = 0;  ///< no scan near them, or after the last points
  std::uint64_t late_scans = 0;
  std::uint64_t bad_values = 0;       ///< measurements that are not finite or without content
  std::uint64_t clock_changes = 0;    ///< a device's clock jumped or got another source
  std::uint64_t clock_lies = 0;       ///< a clock said it was disciplined and was not: fitted from then on
  std::vector<LidarCounters> lidars;  ///< by unit
};

/// Measurements in arrival order to groups in time order. Cuts at the middle of each exposure while the rig's
/// camera delivers, else every period_s; a group leaves when all LiDARs and the IMU are newer than its end
/// (or silent for sensor_gap_s, which only then are not waited for). The points of all LiDARs make one group.
/// Whole scans make one group each, with the nearest image. Every point ends in exactly one group or one
/// counter. With synchronised clocks the result depends on the stamps only, not on how arrivals interleave,
/// as long as images lag less than image_wait_s. Single-owner; cost O(points).
class GroupBuilder {
 public:
  GroupBuilder(const GroupBuilderConfig& config, const sensor::Rig& rig);
  GroupBuilder(GroupBuilder&&) noexcept;
  GroupBuilder& operator=(GroupBuilder&&) noexcept;
  GroupBuilder(const GroupBuilder&) = delete;
  GroupBuilder& operator=(const GroupBuilder&) = delete;
  ~GroupBuilder();

  /// Called within push() with each sample of the IMU that is taken in, in host time, before any group that
  /// it completes.
  void on_imu(std::function<void(const GroupImu&)> listener);
  /// The groups that this measurement completes, oldest first; mostly none or one.
  [[nodiscard]] std::vector<MeasureGroup> push(sensor::Measurement measurement);
  /// At the end of a recording: everything still buffered.
  [[nodiscard]] std::vector<MeasureGroup> flush();
  [[nodiscard]] GroupCounters counters() const;
  /// What is known of a stream's clock; nothing before its first message.
  [[nodiscard]] std::optional<TimeBase::ClockState> clock_state(Stream stream) const;

 private:
  class Stages;
  std::unique_ptr<Stages> stages_;
};

}  // namespace edgesplat::sync
