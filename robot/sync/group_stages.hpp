// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/sync/group_builder.hpp"
#include "robot/sync/image_buffer.hpp"
#include "robot/sync/imu_buffer.hpp"
#include "robot/sync/point_buffer.hpp"
#include "robot/sync/scan_queue.hpp"
#include "robot/sync/time_base.hpp"

#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace edgesplat::sync {

/// How far one stream has come, in host time.
struct Progress {
  std::optional<HostTime> newest;
  void advance(HostTime t) {
    if (!newest || t > *newest) newest = t;
  }
};

/// The inside of GroupBuilder: take_in() sorts measurements into buffers, drain() cuts groups from them.
class GroupBuilder::Stages {
 public:
  Stages(const GroupBuilderConfig& config, const sensor::Rig& rig);

  void on_imu(std::function<void(const GroupImu&)> listener) { imu_listener_ = std::move(listener); }
  void take_in(sensor::Measurement& measurement);
  /// Groups that can leave now; `all`: nothing more will come.
  [[nodiscard]] std::vector<MeasureGroup> drain(bool all);
  [[nodiscard]] GroupCounters counters() const;
  [[nodiscard]] const TimeBase& time_base() const { return time_base_; }

 private:
  void take_in(const sensor::ImuSample& sample);
  void take_in(sensor::LidarPacket& packet);
  void take_in(sensor::LidarScan& scan);
  void take_in(const sensor::CameraFrame& frame);

  /// The next cut if it can be made now.
  [[nodiscard]] std::optional<Cut> next_cut(bool all);
  [[nodiscard]] std::optional<HostTime> next_end(bool all) const;
  [[nodiscard]] bool decide_begin();
  void skip_silence();
  [[nodiscard]] bool sensors_reached(HostTime t) const;
  [[nodiscard]] bool is_out(const Progress& stream) const;
  [[nodiscard]] std::optional<HostTime> newest_data() const;
  [[nodiscard]] std::optional<HostTime> earliest_point() const;
  [[nodiscard]] std::vector<GroupPoint> take_points(const Cut& cut);
  void note_outs();
  [[nodiscard]] MeasureGroup make_group(const Cut& cut);

  [[nodiscard]] bool scan_is_ready(HostTime end, bool all) const;
  [[nodiscard]] MeasureGroup make_scan_group(HostTime end);
  void count_group(const MeasureGroup& group);
  [[nodiscard]] nanoseconds clamp_limit(Stream stream) const;

  GroupBuilderConfig config_;
  std::function<void(const GroupImu&)> imu_listener_;
  bool has_imu_;
  bool has_camera_;
  bool whole_scans_ = false;  ///< the LiDAR delivers scans: they make the groups
  nanoseconds stamp_delay_{};
  TimeBase time_base_;
  /// One LiDAR: its points, how far it has come, and whether it is waited for.
  struct Lidar {
    PointBuffer points;
    Progress progress;
    LidarCounters counters;
  };
  std::vector<Lidar> lidars_;  ///< by unit
  ImuBuffer imu_;
  ImageBuffer images_;
  ScanQueue scans_;
  Progress imu_progress_;
  std::optional<HostTime> first_seen_;  ///< of LiDAR or IMU
  std::optional<HostTime> settled_;     ///< end of the last group: the begin of the next
  std::optional<HostTime> last_image_;  ///< the newest image before the next cut
  GroupCounters counters_;
};

}  // namespace edgesplat::sync
