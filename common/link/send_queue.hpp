// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/ack.hpp"
#include "common/link/train.hpp"
#include "common/link/transport.hpp"

#include <array>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

namespace edgesplat::link {

struct SendLimits {
  std::size_t messages = 64;                   ///< waiting per lane
  std::size_t bytes = std::size_t{64} << 20U;  ///< waiting per lane
};

/// A set of lanes.
using LaneMask = std::array<bool, kLaneCount>;

/// What waits in front of the network: bounded, by lane, the most urgent lane first, messages cut into chunks
/// only as they are sent. Callers push and never wait; the link thread takes chunks and sleeps here when
/// there is nothing to do. Thread-safe; next() and advance() belong to the link thread.
class SendQueue {
 public:
  struct Part {
    Lane lane = Lane::kHeartbeat;
    ChunkHeader header;
    std::span<const std::byte> payload;  ///< valid until advance(lane)
  };

  SendQueue(std::uint64_t session, const SendLimits& limits) : session_(session), limits_(limits) {}

  bool push(Lane lane, map::RobotId robot, std::vector<std::byte> bytes);
  /// The next chunk of the most urgent lane in `allowed` that has one; the same again until advance().
  std::optional<Part> next(const LaneMask& allowed);
  /// The chunk that next() gave for `lane` is sent.
  void advance(Lane lane);
  void count_write_timeout(Lane lane);
  void count_write_failure(Lane lane);
  /// A new peer is there: the message under way starts over, since the peer lacks its beginning.
  void rewind(Lane lane);
  /// `receiver_session`: of the end that acknowledges.
  void on_ack(const Ack& ack, map::RobotId robot, std::uint64_t receiver_session);

  /// Wakes wait_for_work(): something happened outside (data to read, a peer came or went).
  void wake();
  /// Sleeps until next(allowed) has a chunk, wake() was called, `stop` is requested or the time is over.
  void wait_for_work(const LaneMask& allowed, const std::stop_token& stop, nanoseconds timeout);
  /// Waits until the lane is empty and everything of it acknowledged; false on time-out or close().
  bool drain(Lane lane, nanoseconds timeout);
  void close();
  /// Only the fields about sending are filled in.
  [[nodiscard]] LinkCounters counters() const;

 private:
  struct Queued {
    map::RobotId robot;
    std::vector<std::byte> bytes;
    ChunkHeader header;  ///< of the next chunk; numbered once begun
    bool begun = false;
  };
  struct LaneState {
    std::deque<Queued> queue;
    std::size_t bytes = 0;
    LaneCounters counters;
  };
  struct Peer {
    std::uint32_t last_train = 0;
    std::uint64_t receiver_session = 0;
    std::uint64_t acked_before = 0;  ///< by the receiver's earlier sessions
    std::uint64_t acked_now = 0;
  };
  [[nodiscard]] LaneState& state(Lane lane) { return lanes_[static_cast<std::size_t>(lane)]; }
  [[nodiscard]] const LaneState& state(Lane lane) const { return lanes_[static_cast<std::size_t>(lane)]; }
  [[nodiscard]] std::uint64_t acked(Lane lane) const;
  void make_room(LaneState& lane_state, std::size_t bytes);
  [[nodiscard]] bool has_work(const LaneMask& allowed) const;

  const std::uint64_t session_;
  const SendLimits limits_;
  mutable std::mutex mutex_;
  std::condition_variable_any work_;
  std::condition_variable_any drained_;
  std::array<LaneState, kLaneCount> lanes_;
  std::map<std::pair<Lane, map::RobotId>, Peer> peers_;
  bool woken_ = false;
  bool closed_ = false;
};

}  // namespace edgesplat::link
