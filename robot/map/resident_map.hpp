// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/geometry/rigid_transform.hpp"
#include "common/map/delta.hpp"
#include "common/map/map_hash.hpp"
#include "common/time/time.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_set>
#include <vector>

namespace edgesplat::map {

struct ResidentMapConfig {
  RobotId robot{1};                                    ///< deltas for others are refused
  std::size_t budget_bytes = std::size_t{512} << 20U;  ///< for resident Gaussians; over it is counted
  std::size_t max_held_deltas = 64;                    ///< that wait for one before them
  std::size_t max_held_bytes = std::size_t{64} << 20U;
  double publish_period_s = 0.2;  ///< least time between two snapshots, 0..10
};

/// What became of one delta.
enum class ApplyOutcome : std::uint8_t {
  kApplied,     ///< and perhaps held ones after it
  kDuplicate,   ///< seen before: nothing changed
  kHeld,        ///< one before it is missing
  kOldEpoch,    ///< of a server start before the present one: dropped
  kNeedsReset,  ///< of a newer epoch but not its beginning, or too many held: only a snapshot helps
  kCorrupt,     ///< fails its checks, or is for another robot
};

struct ResidentMapCounters {
  std::uint64_t applied = 0;
  std::uint64_t duplicates = 0;
  std::uint64_t held = 0;
  std::uint64_t old_epoch = 0;
  std::uint64_t needs_reset = 0;
  std::uint64_t corrupt = 0;
  std::uint64_t duplicate_ids = 0;  ///< Gaussians not added because their id is resident
  std::uint64_t resets = 0;         ///< a new epoch began: the map was emptied
  std::uint64_t snapshots = 0;
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

/// Which deltas are in the map: everything of `epoch` up to `seq`.
struct MapPosition {
  Epoch epoch;
  std::uint64_t seq = 0;
};

/// The robot's own copy of the map: applies the server's deltas exactly once, in order, and publishes
/// immutable snapshots for the renderer. Thread-safe: apply() on one thread, the rest from any; snapshot()
/// never waits for apply().
class ResidentMap {
 public:
  explicit ResidentMap(const ResidentMapConfig& config);

  /// Applies one delta's bytes; safe to call again with the same bytes. `now` paces the snapshots.
  ApplyOutcome apply(std::span<const std::byte> delta, HostTime now);
  /// Publishes what changed since the last snapshot where the period has passed; call when idle.
  void publish_if_due(HostTime now);
  /// The newest published Gaussians; never null, may be empty.
  [[nodiscard]] std::shared_ptr<const gaussian::GaussianCloud> snapshot() const;
  [[nodiscard]] MapFromOdom map_from_odom() const;
  [[nodiscard]] MapPosition position() const;
  /// Over the robot's own memory; equals the server's after the same deltas.
  [[nodiscard]] std::uint64_t map_hash() const;
  [[nodiscard]] ResidentMapCounters counters() const;

 private:
  struct Held {
    DeltaHeader header;
    std::vector<std::byte> bytes;
  };
  // All with mutex_ held.
  ApplyOutcome place(const DeltaHeader& header, std::span<const std::byte> delta);
  ApplyOutcome hold(const DeltaHeader& header, std::span<const std::byte> delta);
  bool apply_now(const DeltaHeader& header, std::span<const std::byte> bytes);
  void apply_held();
  void reset(const DeltaHeader& header);
  void publish_where_due(HostTime now);

  const ResidentMapConfig config_;
  mutable std::mutex mutex_;  ///< guards everything but published_
  gaussian::GaussianCloud cloud_;
  std::unordered_set<gaussian::GaussianId> resident_;
  MapHash hash_;
  MapUuid map_uuid_;
  MapPosition position_;
  bool started_ = false;
  std::map<std::uint64_t, Held> held_;  ///< by seq
  std::size_t held_bytes_ = 0;
  bool changed_ = false;
  HostTime last_publish_{};
  ResidentMapCounters counters_;

  mutable std::mutex published_mutex_;
  std::shared_ptr<const gaussian::GaussianCloud> published_;
};

}  // namespace edgesplat::map
