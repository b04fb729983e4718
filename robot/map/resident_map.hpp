// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/map/map_state.hpp"
#include "robot/map/delta_gate.hpp"
#include "robot/map/residency.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace edgesplat::map {

struct ResidentMapConfig {
  RobotId robot{1};                                    ///< deltas for others are refused
  std::size_t budget_bytes = std::size_t{512} << 20U;  ///< for resident Gaussians
  std::size_t max_held_deltas = 64;                    ///< that wait for one before them
  std::size_t max_held_bytes = std::size_t{64} << 20U;
  double publish_period_s = 0.2;  ///< least time between two snapshots, 0..10
};

/// What became of one delta.
enum class ApplyOutcome : std::uint8_t {
  kApplied,     ///< and perhaps held ones after it
  kDuplicate,   ///< seen before: nothing changed
  kHeld,        ///< one before it is missing
  kOldEpoch,    ///< of a server start before the present one, or of a map left behind: dropped
  kNeedsReset,  ///< of a newer epoch but not its beginning, or too many held: a snapshot is asked for
  kForeign,     ///< for another robot, or in the middle of a map that is not the one held: refused
  kCorrupt,     ///< fails its checks
};

struct ResidentMapCounters {
  std::uint64_t applied = 0;
  std::uint64_t duplicates = 0;
  std::uint64_t held = 0;
  std::uint64_t old_epoch = 0;
  std::uint64_t needs_reset = 0;
  std::uint64_t foreign = 0;
  std::uint64_t corrupt = 0;
  std::uint64_t resets = 0;     ///< the map was begun anew: another epoch, or a snapshot
  std::uint64_t snapshots = 0;  ///< published to the renderer
  std::uint64_t resends_asked = 0;
  std::uint64_t snapshots_asked = 0;
  std::uint64_t hash_agreed = 0;     ///< server's hashes that equalled the one here at the same delta
  std::uint64_t hash_disagreed = 0;  ///< and those that did not: a snapshot is asked for
  std::uint64_t evicted_chunks = 0;  ///< dropped here over the budget, before the server knew
  std::size_t absent_chunks = 0;     ///< given up; they come back when the robot nears them
  std::size_t gaussians = 0;
  std::size_t resident_bytes = 0;
  std::size_t over_budget_bytes = 0;
  std::size_t held_now = 0;
};

/// The correction from the robot's continuous frame to the server's map, as the server last told it.
struct MapFromOdom {
  geometry::RigidTransform map_from_odom;
  std::uint32_t version = 0;  ///< 0: none yet, identity
};

/// The robot's own copy of the map: applies the server's deltas exactly once, in order, within a byte budget,
/// and publishes immutable snapshots for the renderer. Thread-safe: apply() on one thread, the rest from any;
/// snapshot() never waits for apply().
class ResidentMap {
 public:
  explicit ResidentMap(const ResidentMapConfig& config);

  /// Applies one delta's bytes; safe to call again with the same bytes. `now` paces the snapshots.
  ApplyOutcome apply(std::span<const std::byte> delta, HostTime now);
  /// The server's heartbeat: how far it is, with the hash of what the robot should hold then. `idle`: nothing
  /// of it is queued for this robot.
  void server_at(const MapPosition& position, std::uint64_t hash, bool idle, HostTime now);
  /// Where the robot is: what is near it stays, what is far goes first.
  void robot_at(const Eigen::Vector3f& p_in_map_m);
  /// What to ask the server for now, ready to be encoded; call often (every delta, heartbeat and 50 ms).
  [[nodiscard]] std::vector<MapRequest> requests(HostTime now);

  /// Publishes what changed since the last snapshot where the period has passed; call when idle.
  void publish_if_due(HostTime now);
  /// The same whatever the pace.
  void publish_now(HostTime now);
  /// The newest published Gaussians; never null, may be empty.
  [[nodiscard]] std::shared_ptr<const gaussian::GaussianCloud> snapshot() const;
  /// Keyframes that the server has mapped, and whose part of the map is in what snapshot() gives after this
  /// call; each once, but again after a snapshot of the server's.
  [[nodiscard]] std::vector<std::uint32_t> take_mapped();
  [[nodiscard]] MapFromOdom map_from_odom() const;
  [[nodiscard]] MapPosition position() const;
  /// Over the robot's own memory; equals the server's after the same deltas.
  [[nodiscard]] std::uint64_t map_hash() const;
  [[nodiscard]] ResidentMapCounters counters() const;

 private:
  // All with mutex_ held.
  ApplyOutcome refuse_foreign(const char* why, std::uint64_t seq);
  ApplyOutcome place(const DeltaHeader& header, std::span<const std::byte> delta, HostTime now);
  bool apply_now(std::span<const std::byte> bytes, HostTime now);
  void evict_overflow();
  void publish_where_due(HostTime now);
  void publish(HostTime now);
  [[nodiscard]] std::size_t bytes_each() const;

  const ResidentMapConfig config_;
  mutable std::mutex mutex_;  ///< guards everything but published_
  MapState state_;
  DeltaGate gate_;
  Residency residency_;
  bool more_waits_ = false;  ///< the server has further parts of a snapshot
  std::optional<HostTime> more_asked_;
  unsigned disagreements_ = 0;  ///< in a row
  bool changed_ = false;
  std::vector<std::uint32_t> mapped_;            ///< keyframes, said since the last snapshot
  std::vector<std::uint32_t> published_mapped_;  ///< before it, and not taken yet
  HostTime last_publish_{};
  ResidentMapCounters counters_;

  mutable std::mutex published_mutex_;
  std::shared_ptr<const gaussian::GaussianCloud> published_;
};

}  // namespace edgesplat::map
