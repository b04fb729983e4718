// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulate/world/lane_track.hpp"
#include "tools/simulate/world/mover_body.hpp"

#include <cstdint>
#include <vector>

namespace edgesplat::simulate {

/// A ball and an upright cylinder around one centre that both hold a mover.
struct MoverBall {
  Eigen::Vector3d centre_m;
  double radius_m = 1.0;
  double width_m = 0.6;
};

/// Everybody who moves: a pure function of seed and time. Immutable, thread-safe.
class Crowd {
 public:
  Crowd(const Scene& scene, const WorldConfig& config);

  [[nodiscard]] std::size_t size() const { return members_.size(); }
  [[nodiscard]] const MoverBody& body(std::size_t mover) const { return members_[mover].body; }
  [[nodiscard]] Stance stance(std::size_t mover, double time_s) const;
  [[nodiscard]] MoverBall ball(std::size_t mover, double time_s) const;
  [[nodiscard]] Parts pose(std::size_t mover, const Stance& stance) const;

 private:
  struct Member {
    MoverBody body;
    std::size_t track = 0;
    double start_m = 0.0;
  };
  enum class On : std::uint8_t { kFootways, kRoads };
  void settle(const std::vector<Lane>& lanes, int count, std::uint64_t seed, On on);
  std::vector<LaneTrack> tracks_;
  std::vector<Member> members_;
};

/// The crowd at one time, posed when asked: for single rays.
class CrowdAt {
 public:
  CrowdAt(const Crowd& crowd, double time_s) : crowd_(crowd), time_s_(time_s) {}
  [[nodiscard]] std::size_t size() const { return crowd_.size(); }
  [[nodiscard]] const MoverBody& body(std::size_t mover) const { return crowd_.body(mover); }
  [[nodiscard]] Stance stance(std::size_t mover) const { return crowd_.stance(mover, time_s_); }
  [[nodiscard]] MoverBall ball(std::size_t mover) const { return crowd_.ball(mover, time_s_); }
  [[nodiscard]] Parts parts(std::size_t mover) const { return crowd_.pose(mover, stance(mover)); }

 private:
  const Crowd& crowd_;
  double time_s_;
};

/// The crowd at one time, posed beforehand: for whole pictures. Immutable, thread-safe.
class PosedCrowd {
 public:
  PosedCrowd(const Crowd& crowd, double time_s);
  [[nodiscard]] std::size_t size() const { return balls_.size(); }
  [[nodiscard]] const MoverBody& body(std::size_t mover) const { return crowd_.body(mover); }
  [[nodiscard]] const Stance& stance(std::size_t mover) const { return stances_[mover]; }
  [[nodiscard]] const MoverBall& ball(std::size_t mover) const { return balls_[mover]; }
  [[nodiscard]] const Parts& parts(std::size_t mover) const { return parts_[mover]; }

 private:
  const Crowd& crowd_;
  std::vector<Stance> stances_;
  std::vector<MoverBall> balls_;
  std::vector<Parts> parts_;
};

}  // namespace edgesplat::simulate
