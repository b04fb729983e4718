// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/rigid_transform.hpp"
#include "common/sensor/image.hpp"
#include "common/sensor/rig.hpp"
#include "common/time/time.hpp"
#include "robot/sync/patch_flow.hpp"

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace edgesplat::sync {

/// A software check of what hardware is to ensure: that the camera shares the time of LiDAR and IMU. Whatever
/// a picture shows moves from one picture to the next as the tracked motion and the LiDAR's depth say; where
/// stamps are late, as the motion of an earlier moment does. The difference, over many patches of many
/// pictures, is the delay. (The rotation of pictures alone is no measure: near walls a sideways sway looks
/// like one.) When the delay is over the limit, pictures must not colour points. Single-owner; some ms a
/// picture.
class CameraOffset {
 public:
  struct Config {
    double limit_s = 0.005;   ///< [0.001, 0.05]
    double window_s = 20.0;   ///< what an estimate is made of, [5, 120]
    double sigma_s = 0.002;   ///< an estimate that is less certain says nothing
    int least_pictures = 30;  ///< in it
  };
  struct Estimate {
    double delay_s = 0.0;  ///< positive: the camera's stamps are late
    double sigma_s = 0.0;  ///< 1 sigma, from the scatter between pictures
    int pictures = 0;
  };
  CameraOffset(const Config& config, const sensor::CameraMount& mount) : config_(config), mount_(mount) {}

  /// One picture in time order: the pose at its stamp, and points around the robot at that time in the body
  /// frame.
  void add(HostTime stamp, const geometry::RigidTransform& odom_from_body,
           std::span<const Eigen::Vector3f> points_in_body_m, const sensor::ImageRgb8& picture);
  /// Nothing until the motion was lively and long enough.
  [[nodiscard]] std::optional<Estimate> estimate() const;
  /// False while the delay is surely over the limit.
  [[nodiscard]] bool in_sync() const { return in_sync_; }
  /// Times that the camera went out of sync.
  [[nodiscard]] std::uint64_t alarms() const { return alarms_; }

 private:
  struct Moment {
    HostTime stamp;
    geometry::RigidTransform odom_from_camera;
    SmallPicture picture;
    std::vector<Eigen::Vector3d> points_in_camera_m;
  };
  /// How far a patch was found from where the stamps' poses put it.
  struct Miss {
    Eigen::Vector3d p_in_camera_m;  ///< in the earlier picture's
    Eigen::Vector2d off_px;         ///< small pixels
  };
  /// The normal equation of one pair of pictures.
  struct Pair {
    HostTime stamp;
    double information;  ///< sum of J^2
    double pull;         ///< sum of J r
  };
  [[nodiscard]] std::vector<Eigen::Vector3d> choose_points(
      const Moment& moment, std::span<const Eigen::Vector3f> points_in_body_m) const;
  [[nodiscard]] std::vector<Miss> compare(const Moment& before, const Moment& now) const;
  void settle_pair();
  void judge(HostTime now);
  [[nodiscard]] std::optional<Eigen::Vector2d> small_pixel(const Eigen::Vector3d& p_in_camera_m,
                                                           double scale) const;

  Config config_;
  sensor::CameraMount mount_;
  std::deque<Moment> moments_;  ///< the newest four
  std::vector<Miss> misses_;    ///< between the second and third of them, once there are four
  std::vector<Miss> newest_misses_;
  std::deque<Pair> pairs_;
  HostTime next_judgement_ = HostTime::min();
  int over_ = 0;  ///< judgements in a row over the limit
  bool in_sync_ = true;
  std::uint64_t alarms_ = 0;
};

}  // namespace edgesplat::sync
