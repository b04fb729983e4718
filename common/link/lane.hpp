// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace edgesplat::link {

/// Which end of the link this is: a robot talks to the server, the server to every robot.
enum class Role : std::uint8_t { kRobot, kServer };

/// A kind of traffic with its own topic, quality of service and queue; in the order of priority.
enum class Lane : std::uint8_t {
  kHeartbeat,  ///< both ways, best effort, only the newest counts
  kAck,        ///< both ways, cumulative, only the newest counts; made and read by the link itself
  kRequest,    ///< robot to server, reliable: what the robot's copy of the map lacks (map::MapRequest)
  kDelta,      ///< server to robot, reliable, in order
  kKeyframe,   ///< robot to server, reliable
  kSpool,      ///< robot to server, reliable: keyframes of earlier, when nothing else wants the link
  kProbe,      ///< robot to server, best effort: padding that measures the link; ends in the link itself
};
inline constexpr std::size_t kLaneCount = 7;
inline constexpr std::array<Lane, kLaneCount> kLanes = {
    Lane::kHeartbeat, Lane::kAck, Lane::kRequest, Lane::kDelta, Lane::kKeyframe, Lane::kSpool, Lane::kProbe};
[[nodiscard]] std::string_view to_string(Lane lane);
[[nodiscard]] constexpr std::size_t index_of(Lane lane) {
  return static_cast<std::size_t>(lane);
}

/// True where only the newest message matters: a newer one replaces an older one that waits.
[[nodiscard]] constexpr bool newest_only(Lane lane) {
  return lane == Lane::kHeartbeat || lane == Lane::kAck;
}
/// True where a lane of one direction leads from the robot to the server.
[[nodiscard]] constexpr bool goes_up(Lane lane) {
  return lane == Lane::kRequest || lane == Lane::kKeyframe || lane == Lane::kSpool || lane == Lane::kProbe;
}
/// True where what is not acknowledged is sent again.
[[nodiscard]] constexpr bool reliable(Lane lane) {
  return !newest_only(lane) && lane != Lane::kProbe;
}
/// Small and urgent: never waits behind bulk traffic.
[[nodiscard]] constexpr bool urgent(Lane lane) {
  return newest_only(lane) || lane == Lane::kRequest;
}
/// True where this end sends on the lane / receives from it.
[[nodiscard]] constexpr bool sends(Role role, Lane lane) {
  return newest_only(lane) || goes_up(lane) == (role == Role::kRobot);
}
[[nodiscard]] constexpr bool receives(Role role, Lane lane) {
  return newest_only(lane) || goes_up(lane) == (role == Role::kServer);
}
/// True where messages are for the user of the link, not for the link itself.
[[nodiscard]] constexpr bool is_for_user(Lane lane) {
  return lane != Lane::kAck && lane != Lane::kProbe;
}

}  // namespace edgesplat::link
