// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/tracking/block_loop.hpp"
#include "robot/tracking/calibration_watch.hpp"
#include "robot/tracking/free_motion.hpp"
#include "robot/tracking/gaussian_update.hpp"
#include "robot/tracking/imu_initialiser.hpp"
#include "robot/tracking/moving_start.hpp"
#include "robot/tracking/plane_map.hpp"
#include "robot/tracking/relocalise.hpp"
#include "robot/tracking/rest_detector.hpp"
#include "robot/tracking/scan_update.hpp"
#include "robot/tracking/sweep.hpp"
#include "robot/tracking/track_keeper.hpp"
#include "robot/tracking/tracker.hpp"
#include "robot/tracking/visual_front.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::tracking {

constexpr int kRedrawnScans = 4;

/// Whether the IMU's samples hold a weight: without, they tell rotations alone (see MovingStart).
enum class Gravity : std::uint8_t { kFelt, kNone };

[[nodiscard]] PlaneMapConfig map_config(const TrackingConfig& config);
[[nodiscard]] GaussianUpdateConfig gaussian_config(const TrackingConfig& config);
/// Nothing tells a camera's delay where no pictures are used.
[[nodiscard]] TrackingConfig calibration_config(const TrackingConfig& config, const sensor::Rig& rig);

/// The stages of one group, in their order. See Tracker.
struct Tracker::Impl {
  Impl(const TrackingConfig& config_in, const sensor::Rig& rig_in, Gravity gravity_in = Gravity::kFelt);
  ~Impl();

  Result<TrackedGroup> track(const sync::MeasureGroup& group);

  Status check_times(const sync::MeasureGroup& group) const;
  void clean_imu(const sync::MeasureGroup& group);
  /// Sets the first belief once there is one.
  void initialise(const sync::MeasureGroup& group);
  /// From rest where there is rest, else in motion.
  void initialise_with_imu(const sync::MeasureGroup& group);
  TrackedGroup start_in_motion(const sync::MeasureGroup& group);
  [[nodiscard]] std::int64_t refused_starts() const;
  TrackedGroup start(const sync::MeasureGroup& group);
  /// How far the calibration shows in the group.
  void watch_calibration(const sync::MeasureGroup& group, Prediction& prediction);
  /// Null where the camera's delay is exactly none.
  [[nodiscard]] const CalibrationView* picture_calibration() const;
  /// The moment whose pose the group's points are to tell.
  HostTime update_time(const sync::MeasureGroup& group) const;
  Prediction predict(const sync::MeasureGroup& group);
  ScanUpdateResult match(const Prediction& prediction, const FilterState& start_at);
  ScanUpdateResult update(Prediction& prediction, HostTime at);
  /// An update that lies wrongly is taken back; a lost pose is looked for in the map.
  void check(ScanUpdateResult& result, const Prediction& prediction);
  [[nodiscard]] std::optional<ScanUpdateResult> look_for_pose(const Prediction& prediction);
  /// What state the group's updates leave tracking in.
  void judge(const ScanUpdateResult& scan, const VisualUpdateResult& picture, double dt_s);
  /// Nothing around fits for long, although there are points: the map is begun anew where the body is thought
  /// to be.
  void begin_again();
  [[nodiscard]] bool unmapped(const ScanUpdateResult& result) const;
  void pick_scan_points();
  [[nodiscard]] ScanView scan_view() const;
  /// Rest tells the speed along what the LiDAR does not see.
  void use_rest(const ScanUpdateResult& result);
  /// The picture's update, at the moment of the LiDAR's.
  VisualUpdateResult see(const sync::MeasureGroup& group);
  /// The Gaussian map's update, after the picture's patches.
  GaussianUpdateResult look_at_gaussians(const sync::MeasureGroup& group, const ScanUpdateResult& scan);
  void extend_map(const ScanUpdateResult& update);
  void insert_points(std::span<const Eigen::Vector3f> points_in_body_m, std::span<const std::uint8_t> units,
                     std::span<const std::uint32_t> kept, const geometry::RigidTransform& pose,
                     const Matrix6d& pose_covariance);
  [[nodiscard]] TrackedGroup report(const sync::MeasureGroup& group, const ScanUpdateResult& scan,
                                    const VisualUpdateResult& picture,
                                    const GaussianUpdateResult& gaussians) const;

  TrackingConfig config;
  sensor::Rig rig;
  Gravity gravity;
  TrackingCounters counters;
  BlockLoop loop;
  std::vector<Beam> beams;  ///< of the rig's LiDARs
  PlaneMap map;
  ScanUpdater updater;
  Sweep sweep;
  FreeMotion free_motion;
  ImuInitialiser initialiser;
  std::unique_ptr<MovingStart> moving_start;  ///< until the first pose
  std::optional<MovingStartResult> started;   ///< the group that it was found with is in hand
  RestDetector rest;
  CalibrationWatch watch;
  bool estimates_calibration = false;
  CalibrationView scan_calibration;  ///< of the group in hand
  CalibrationView camera_calibration;
  SensorCalibration deskewed_with;  ///< the scan in hand
  TrackKeeper keeper;
  TrackingState state = TrackingState::kInitialising;
  int searches = 0;  ///< for the pose that is lost
  int groups_since_search = 0;
  std::optional<VisualFront> visual;
  bool picture_taken = false;         ///< the group's picture is in `visual`
  std::vector<TrackedPatch> patches;  ///< of that picture
  std::optional<GaussianUpdater> gaussian_updater;
  std::shared_ptr<GaussianView> gaussian_view;
  int pictures_since_look = 0;
  bool with_imu;                                           ///< decided at the first pose, then fixed
  Eigen::Matrix3d unseen_steps = Eigen::Matrix3d::Zero();  ///< projector on what the last scan did not see
  int groups_without_imu = 0;                              ///< in a row, before the first pose
  int scans_to_redraw = 0;                                 ///< of a start in motion
  std::optional<HostTime> last_end;
  std::optional<FilterBelief> belief;
  HostTime belief_time{};                      ///< last_end, or the middle of its points without an IMU
  std::vector<sync::GroupImu> imu;             ///< the group's good samples; the newest ever when it has none
  std::vector<Eigen::Vector3f> scan_points_m;  ///< matched against the map
  std::vector<std::uint8_t> scan_units;        ///< which LiDAR measured them
  std::vector<MapPoint> map_points;
};

}  // namespace edgesplat::tracking
