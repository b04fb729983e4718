// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/simulate/world/crowd.hpp"

#include "tools/simulate/noise.hpp"

#include <utility>

namespace edgesplat::simulate {

Crowd::Crowd(const Scene& scene, const WorldConfig& config) {
  if (!scene.footways.empty()) settle(scene.footways, config.pedestrians, config.seed, On::kFootways);
  if (!scene.roads.empty()) settle(scene.roads, config.cars, config.seed ^ 0xCA55ULL, On::kRoads);
}

/// Deals movers out to the lanes in turn and spreads those of a lane along it, each within its own stretch,
/// so that none runs into another: all on a lane go at one speed.
void Crowd::settle(const std::vector<Lane>& lanes, int count, std::uint64_t seed, On on) {
  const std::size_t first_track = tracks_.size();
  for (const Lane& lane : lanes) tracks_.emplace_back(lane);
  const auto total = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < total; ++i) {
    const std::size_t lane = i % lanes.size(), place = i / lanes.size();
    const std::size_t on_lane = (total - lane + lanes.size() - 1) / lanes.size();
    NoiseStream draw(seed, NoisePurpose::kCrowd, 100 + i);
    const double stretch_m = tracks_[first_track + lane].length_m() / static_cast<double>(on_lane);
    Member member;
    member.body = on == On::kFootways ? make_pedestrian(draw.bits()) : make_car(draw.bits());
    member.track = first_track + lane;
    member.start_m = stretch_m * (static_cast<double>(place) + 0.5 * draw.uniform());
    members_.push_back(std::move(member));
  }
}

Stance Crowd::stance(std::size_t mover, double time_s) const {
  const Member& member = members_[mover];
  return tracks_[member.track].at(member.start_m, time_s);
}

MoverBall Crowd::ball(std::size_t mover, double time_s) const {
  const Member& member = members_[mover];
  return {tracks_[member.track].foot_m(member.start_m, time_s) +
              Eigen::Vector3d(0, 0, member.body.height_m / 2.0),
          member.body.reach_m, member.body.width_m};
}

Parts Crowd::pose(std::size_t mover, const Stance& stance) const {
  const MoverBody& body = members_[mover].body;
  return body.kind == MoverBody::Kind::kCar ? pose_car(body, stance) : pose_pedestrian(body, stance);
}

PosedCrowd::PosedCrowd(const Crowd& crowd, double time_s) : crowd_(crowd) {
  for (std::size_t i = 0; i < crowd.size(); ++i) {
    stances_.push_back(crowd.stance(i, time_s));
    balls_.push_back(crowd.ball(i, time_s));
    parts_.push_back(crowd.pose(i, stances_.back()));
  }
}

}  // namespace edgesplat::simulate
