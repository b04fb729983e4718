// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
// The part of Tracker::Impl that keeps the map, and finds a lost pose in it.
#include "robot/tracking/tracker_impl.hpp"

#include <algorithm>
#include <cmath>

namespace edgesplat::tracking {
namespace {

constexpr std::size_t kBlockSize = 1024;
/// After a start in motion the map is drawn anew from each of this many scans: until the speed is known,
/// scans are deskewed wrongly, and a bent first map would bend everything after it.
constexpr double kSmoothStart_mps = 0.1;
/// A lost pose is looked for this often, a little farther each time, and given up after so long.
constexpr int kGroupsBetweenSearches = 5;
constexpr double kFirstSearch_m = 3.0;
constexpr double kFartherSearch_m = 2.0;
constexpr double kFarthestSearch_m = 12.0;
constexpr std::size_t kLikelyPoses = 6;
constexpr double kGiveUp_s = 8.0;

}  // namespace

bool Tracker::Impl::unmapped(const ScanUpdateResult& result) const {
  return static_cast<std::size_t>(result.last.matched) * 10 < scan_points_m.size();
}

std::optional<ScanUpdateResult> Tracker::Impl::look_for_pose(const Prediction& prediction) {
  const Eigen::Matrix3d doubt = prediction.belief.covariance.block<3, 3>(kPos, kPos);
  PoseSearch search;
  search.radius_m =
      std::min(std::max(kFirstSearch_m, 2.0 * std::sqrt(doubt.trace())) + kFartherSearch_m * searches,
               kFarthestSearch_m);
  ++searches;
  FilterBelief wide = prediction.belief;
  wide.covariance.block<3, 3>(kPos, kPos).diagonal().array() += search.radius_m * search.radius_m / 4.0;
  wide.covariance.block<3, 3>(kRot, kRot).diagonal().array() += search.heading_rad * search.heading_rad / 4.0;
  std::optional<ScanUpdateResult> best;
  const geometry::RigidTransform& guess = prediction.belief.state.odom_from_body;
  for (const auto& pose : likely_poses(map, scan_points_m, guess, search, loop, kLikelyPoses)) {
    FilterState start = prediction.belief.state;
    start.odom_from_body = pose;
    start.calibration = deskewed_with;
    const ScanUpdateResult found = updater.run(wide, start, scan_view(), map);
    const bool seen = static_cast<std::size_t>(found.last.used) * 2 > scan_points_m.size();
    if (!keeper.fits(found) || !seen || (best && best->last.used >= found.last.used)) continue;
    best = found;
  }
  return best;
}

void Tracker::Impl::check(ScanUpdateResult& result, const Prediction& prediction) {
  const bool was_lost = keeper.lost();
  if (result.updated && (keeper.fits(result) || scans_to_redraw > 0)) {
    // A scan that lies on the map by half is no proof of where the body is, once that is in doubt.
    if (!was_lost || static_cast<std::size_t>(result.last.used) * 2 > scan_points_m.size()) {
      keeper.learn(result);
      counters.recoveries += was_lost ? 1 : 0;
      return;
    }
  }
  if (result.updated) ++counters.misfit_scans;
  if (was_lost && !scan_points_m.empty() && ++groups_since_search >= kGroupsBetweenSearches) {
    groups_since_search = 0;
    if (auto found = look_for_pose(prediction)) {
      result = *std::move(found);
      keeper.learn(result);
      ++counters.recoveries;
      return;
    }
  }
  result.updated = false;
  result.belief = prediction.belief;
}

void Tracker::Impl::judge(const ScanUpdateResult& scan, const VisualUpdateResult& picture, double dt_s) {
  GroupEvidence evidence;
  evidence.scan_fits = scan.updated;
  evidence.scan_sees_all = scan.observed.frozen == 0;
  evidence.picture = picture.updated;
  evidence.position_sigma_m = std::sqrt(belief->covariance.block<3, 3>(kPos, kPos).trace());
  evidence.dt_s = dt_s;
  state = keeper.next(evidence);
  if (!keeper.lost()) searches = 0;
  if (keeper.lost_s() > kGiveUp_s && !scan_points_m.empty()) begin_again();
}

void Tracker::Impl::begin_again() {
  map = PlaneMap(map_config(config));
  if (visual) visual.emplace(config, *rig.camera, largest_noise(rig), loop);
  keeper.restart();
  searches = 0;
  ++counters.map_restarts;
}

void Tracker::Impl::extend_map(const ScanUpdateResult& result) {
  // A lost pose must not spoil the map; an unmapped place must enter it.
  if (!result.updated && (!unmapped(result) || keeper.lost())) return;
  if (scans_to_redraw > 0 && result.updated) {
    --scans_to_redraw;
    const bool was_bent =
        sweep.has_point_times() && belief->state.velocity_in_odom_mps.norm() > kSmoothStart_mps;
    if (was_bent) map = PlaneMap(map_config(config));
  }
  const auto points = sweep.points_in_body_m();
  const auto kept = sweep.thinned(config.map_voxel_m);
  insert_points(points, sweep.units(), kept, belief->state.odom_from_body,
                belief->covariance.topLeftCorner<6, 6>());
  map.slide(belief->state.odom_from_body.translation_m);
}

void Tracker::Impl::insert_points(std::span<const Eigen::Vector3f> points,
                                  std::span<const std::uint8_t> units, std::span<const std::uint32_t> kept,
                                  const geometry::RigidTransform& pose, const Matrix6d& pose_covariance) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const Eigen::Matrix3f rotation_f = rotation.cast<float>();
  const Eigen::Matrix3f rotation_noise = pose_covariance.block<3, 3>(kRot, kRot).cast<float>();
  const Eigen::Matrix3f position_noise = pose_covariance.block<3, 3>(kPos, kPos).cast<float>();
  map_points.resize(kept.size());
  loop.run(kept.size(), kBlockSize, [&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Eigen::Vector3f& p = points[kept[i]];
      const Beam& beam = beams[units[kept[i]]];
      const Eigen::Matrix3f in_body = beam.noise.covariance(p - beam.lidar_in_body_m);
      Eigen::Matrix3f lever;
      lever << 0.0F, -p.z(), p.y(), p.z(), 0.0F, -p.x(), -p.y(), p.x(), 0.0F;
      const Eigen::Matrix3f turned = rotation_f * lever;
      map_points[i].p_in_odom_m = rotation * p.cast<double>() + pose.translation_m;
      map_points[i].covariance_m2 = pack(rotation_f * in_body * rotation_f.transpose());
      map_points[i].pose_covariance_m2 = pack(turned * rotation_noise * turned.transpose() + position_noise);
    }
  });
  std::vector<Eigen::Vector3d> lidars_in_odom_m;
  for (const Beam& beam : beams) lidars_in_odom_m.push_back(pose * beam.lidar_in_body_m.cast<double>());
  for (std::size_t i = 0; i < kept.size(); ++i) map.insert(map_points[i], lidars_in_odom_m[units[kept[i]]]);
}

}  // namespace edgesplat::tracking
