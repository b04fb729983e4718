// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/delta_codec.hpp"
#include "common/map/map_request.hpp"
#include "common/map/map_state.hpp"
#include "common/time/time.hpp"
#include "server/stream/chunk_plan.hpp"
#include "server/stream/delta_ring.hpp"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <unordered_set>
#include <vector>

namespace edgesplat::stream {

struct DeltaStreamConfig {
  map::RobotId robot;
  map::MapUuid map;
  map::Epoch epoch;
  std::size_t max_rows = 4096;                         ///< Gaussians in one delta, 1..65536
  std::size_t max_deltas = 32;                         ///< about so many at one call, 1..; the rest waits
  std::size_t ring_deltas = 512;                       ///< kept for resends
  std::size_t ring_bytes = std::size_t{16} << 20U;     ///< the same
  std::size_t window_bytes = std::size_t{256} << 10U;  ///< of chunks on their way to the robot
  float tolerance = 1.0F;  ///< changes of the map that are not worth an UPDATE, times what nobody sees
};

struct DeltaStreamCounters {
  std::uint64_t added = 0;  ///< Gaussians in ADDs, and so on
  std::uint64_t updated = 0;
  std::uint64_t removed = 0;
  std::uint64_t chunks = 0;  ///< sent as a whole
  std::uint64_t snapshots = 0;
  std::uint64_t resent = 0;     ///< deltas
  std::uint64_t add_bytes = 0;  ///< whole deltas with their headers
  std::uint64_t update_bytes = 0;
  std::uint64_t unquantisable = 0;  ///< rows passed over: not finite or beyond the map
  std::uint64_t refused = 0;        ///< deltas that could not be encoded: a bug of ours
  std::size_t waiting = 0;          ///< Gaussians whose change has not been sent yet
  std::size_t waiting_chunks = 0;   ///< that the robot is to get as a whole
};

/// How far a stream is and what the robot holds then.
struct StreamPosition {
  std::uint64_t seq = 0;       ///< of the last delta made; 0 before the first
  std::uint64_t map_hash = 0;  ///< over what the robot holds after it
  std::size_t gaussians = 0;   ///< that it holds then
};

/// An encoded delta.
using Bytes = std::vector<std::byte>;

/// Tells one robot how its map changes, in deltas that build on each other, and keeps what the robot holds
/// after them: only differences to that are sent. Thread-safe: publish() and answer() may be called from
/// different threads; whatever the order in which their deltas are sent, the robot applies them by number.
class DeltaStream {
 public:
  explicit DeltaStream(const DeltaStreamConfig& config);

  /// What the robot has to be told so that it holds `cloud` (the map in full precision; one SH degree for
  /// life), of which `changed_rows` are new or other than at the last call and `removed` are gone. In this
  /// order and up to about `byte_budget`: what is gone, chunks the robot asked for, new Gaussians, then
  /// changes, the most visible first. What does not fit waits for the next call; so do chunks beyond the
  /// window. Call it again with no changes to go on.
  std::vector<Bytes> publish(const gaussian::GaussianCloud& cloud,
                             std::span<const std::uint32_t> changed_rows,
                             std::span<const gaussian::GaussianId> removed, std::size_t byte_budget);
  /// The robot moves its Gaussians itself; the caller moves `cloud` by the same map::Repose.
  std::vector<Bytes> repose(std::span<const map::PoseCorrection> corrections);
  std::vector<Bytes> mask(const map::MaskBody& mask);
  /// What these keyframes showed is in the cloud from the next publish() on. The robot is told when all the
  /// Gaussians that are new then are sent, and again after every snapshot.
  void mapped(std::span<const std::uint32_t> keyframes);

  /// Takes a robot's request: what is kept is sent again at once, the rest comes with the next publish().
  std::vector<Bytes> answer(const map::MapRequest& request, HostTime now);
  /// The robot's heartbeat says what it has applied.
  void confirmed(map::Epoch epoch, std::uint64_t seq);

  [[nodiscard]] StreamPosition position() const;
  [[nodiscard]] DeltaStreamCounters counters() const;

 private:
  struct Outbox;
  struct Changes;
  /// A Gaussian of the cloud that differs from what the robot holds.
  struct Update {
    float priority;
    map::FieldMask fields;
    std::uint32_t row;
  };
  // All with mutex_ held.
  bool emit(map::Delta delta, Outbox& out);
  void send_removed(std::vector<gaussian::GaussianId> ids, Outbox& out);
  /// True where all of them were sent.
  bool send_added(map::QuantisedRows rows, Outbox& out);
  void send_mapped(Outbox& out);
  void send_updates(const gaussian::GaussianCloud& cloud, std::vector<Update> updates, Outbox& out);
  bool send_update(const gaussian::GaussianCloud& cloud, std::span<const Update> updates, Outbox& out);
  void send_chunks(const gaussian::GaussianCloud& cloud, Outbox& out);
  void send_chunk(const gaussian::GaussianCloud& cloud, const map::ChunkId& chunk,
                  std::span<const std::uint32_t> rows, Outbox& out);
  void begin_snapshot(const gaussian::GaussianCloud& cloud, Outbox& out);
  [[nodiscard]] map::ChunkId place(const gaussian::GaussianCloud& cloud, std::size_t row) const;
  [[nodiscard]] std::vector<std::uint32_t> candidates(const gaussian::GaussianCloud& cloud,
                                                      std::span<const std::uint32_t> changed_rows) const;
  [[nodiscard]] Changes sort_out(const gaussian::GaussianCloud& cloud, std::span<const std::uint32_t> rows);
  std::vector<Bytes> resend(std::uint64_t first, std::uint64_t last);
  void ask_snapshot(const map::MapRequest& request);

  const DeltaStreamConfig config_;
  mutable std::mutex mutex_;
  map::MapState held_;  ///< by the robot, after seq_
  std::uint64_t seq_ = 0;
  DeltaRing ring_;
  ChunkPlan plan_;
  std::unordered_set<gaussian::GaussianId> waiting_;  ///< changed, not sent yet
  std::optional<Eigen::Vector3f> snapshot_near_m_;    ///< one is due, nearest to this place first
  bool begins_anew_ = false;                          ///< the next delta starts from an empty map
  std::uint64_t snapshot_seq_ = 0;                    ///< first delta of the last snapshot
  HostTime snapshot_asked_{};
  double bytes_per_update_ = 12.0;         ///< as measured
  std::set<std::uint32_t> mapped_;         ///< keyframes, all
  std::set<std::uint32_t> untold_mapped_;  ///< of them, those the robot is still to be told
  std::set<map::ChunkId> to_drop_;         ///< the robot asked to be rid of
  DeltaStreamCounters counters_;
};

}  // namespace edgesplat::stream
