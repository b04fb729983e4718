// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/ack.hpp"
#include "common/link/flight.hpp"
#include "common/link/transport.hpp"

#include <array>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>

namespace edgesplat::link {

struct SendLimits {
  std::size_t messages = 64;                   ///< waiting per lane
  std::size_t bytes = std::size_t{64} << 20U;  ///< waiting per lane
  FlightLimits flight;                         ///< begun and not acknowledged, per lane and robot
};

/// A set of lanes.
using LaneMask = std::array<bool, kLaneCount>;
inline constexpr LaneMask kAllLanes = [] {
  LaneMask mask{};
  for (bool& lane : mask) lane = true;
  return mask;
}();

/// What waits in front of the network and what is on its way: bounded, by lane, the most urgent lane first,
/// messages cut into chunks only as they are sent, chunks of reliable lanes sent again until they are
/// acknowledged. Callers push and never wait; the link's thread takes chunks and sleeps here when there is
/// nothing to do. Thread-safe; next() and sent() belong to the link's thread.
class SendQueue {
 public:
  struct Part {
    Lane lane = Lane::kHeartbeat;
    ChunkHeader header;                  ///< complete, with its CRC32C
    std::span<const std::byte> payload;  ///< valid until sent()
  };

  SendQueue(std::uint64_t session, const SendLimits& limits) : session_(session), limits_(limits) {}

  bool push(Lane lane, map::RobotId robot, std::vector<std::byte> bytes);
  /// The next chunk of the most urgent lane in `allowed` that has one; the same again until sent().
  std::optional<Part> next(const LaneMask& allowed, HostTime now);
  /// The chunk that next() gave is with the network.
  void sent(HostTime now);
  void count_busy(Lane lane);
  void count_write_failure(Lane lane);
  /// A new peer is there: what is under way starts over, since the peer lacks its beginning.
  void start_over(Lane lane);
  /// `receiver_session`: of the end that acknowledges.
  Flight::News on_ack(const Ack& ack, nanoseconds came_after, map::RobotId robot,
                      std::uint64_t receiver_session, HostTime now);
  /// How many bytes of bulk lanes may be on their way to a robot (or from it to the server) at a time.
  void set_window(map::RobotId robot, std::size_t bytes);

  /// Bulk messages wait or have chunks that were never sent.
  [[nodiscard]] bool bulk_waits(map::RobotId robot) const;
  [[nodiscard]] std::size_t bulk_bytes_on_the_way(map::RobotId robot) const;
  /// Takes back what has not begun to travel, oldest first.
  std::vector<std::vector<std::byte>> withdraw(Lane lane, map::RobotId robot);
  /// Of messages that have not begun to travel.
  [[nodiscard]] std::size_t waiting_bytes(Lane lane, map::RobotId robot) const;
  /// When next() may have something without anything happening before.
  [[nodiscard]] std::optional<HostTime> next_timeout() const;

  /// Wakes wait_for_work(): something happened outside (data to read, a peer came or went).
  void wake();
  /// Sleeps until a message was pushed, wake() was called, `stop` is requested or the time is over.
  void wait_for_work(const std::stop_token& stop, nanoseconds timeout);
  /// Waits until the lane is empty and everything of it acknowledged or given up; false on time-out or
  /// close().
  bool drain(Lane lane, nanoseconds timeout);
  void close();
  /// Only the fields about sending are filled in.
  [[nodiscard]] LinkCounters counters() const;

 private:
  struct Queued {
    map::RobotId robot;
    std::vector<std::byte> bytes;
    ChunkHeader header;
  };
  struct Peer {
    explicit Peer(const FlightLimits& limits) : flight(limits) {}
    Flight flight;
    std::uint32_t last_train = 0;
    std::uint64_t receiver_session = 0;
    std::uint64_t acked_before = 0;  ///< by the receiver's earlier sessions
    std::uint64_t acked_now = 0;
  };
  struct LaneState {
    std::deque<Queued> queue;  ///< waiting
    std::size_t bytes = 0;
    std::map<map::RobotId, Peer> peers;
    std::optional<Queued> single;  ///< newest_only: what next() gave and sent() will remove
    LaneCounters counters;
  };
  struct Chosen {
    Lane lane;
    map::RobotId robot;
    std::size_t bytes;
  };
  [[nodiscard]] LaneState& state(Lane lane) { return lanes_[index_of(lane)]; }
  [[nodiscard]] const LaneState& state(Lane lane) const { return lanes_[index_of(lane)]; }
  Peer& peer(Lane lane, map::RobotId robot);
  static void make_room(LaneState& lane_state, const SendLimits& limits, std::size_t bytes);
  std::optional<Part> next_single(Lane lane);
  std::optional<Part> next_of_flights(Lane lane, HostTime now);
  std::optional<Part> begin_next(Lane lane, HostTime now);
  Part chosen(Lane lane, map::RobotId robot, ChunkHeader header, std::span<const std::byte> payload);
  [[nodiscard]] std::size_t window_left(Lane lane, map::RobotId robot) const;
  [[nodiscard]] bool settled(Lane lane) const;

  const std::uint64_t session_;
  const SendLimits limits_;
  mutable std::mutex mutex_;
  std::condition_variable_any work_;
  std::condition_variable_any drained_;
  std::array<LaneState, kLaneCount> lanes_;
  std::map<map::RobotId, std::size_t> windows_;
  std::optional<Chosen> chosen_;
  bool woken_ = false;
  bool closed_ = false;
};

}  // namespace edgesplat::link
