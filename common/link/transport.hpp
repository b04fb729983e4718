// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/link/impairment.hpp"
#include "common/link/lane.hpp"
#include "common/map/ids.hpp"
#include "common/time/time.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace edgesplat::link {

/// A message is a whole keyframe, delta or heartbeat; how it is cut up on the way is the link's business.
inline constexpr std::size_t kMaxMessage_bytes = std::size_t{32} << 20U;

struct Message {
  Lane lane = Lane::kHeartbeat;
  map::RobotId robot;         ///< the robot at the far end (server) or this robot (robot)
  std::uint64_t session = 0;  ///< changes whenever the sender restarts
  std::vector<std::byte> bytes;
};

/// What became of the traffic of one lane since start. Every message is in one of the counters.
struct LaneCounters {
  std::uint64_t messages_offered = 0;    ///< send() was called
  std::uint64_t messages_dropped = 0;    ///< shed from the full queue before any of it was sent
  std::uint64_t messages_replaced = 0;   ///< overtaken by a newer one (newest_only lanes)
  std::uint64_t messages_withdrawn = 0;  ///< taken back before any of it was sent
  std::uint64_t messages_sent = 0;       ///< every chunk was handed to the network
  std::uint64_t messages_acked = 0;      ///< the peer says it has them whole
  std::uint64_t messages_given_up = 0;   ///< not acknowledged after the last try
  std::uint64_t chunks_sent = 0;         ///< repetitions too
  std::uint64_t chunks_resent = 0;       ///< of them repetitions
  std::uint64_t bytes_sent = 0;          ///< payload, without headers
  std::uint64_t write_timeouts = 0;      ///< the network took nothing for now; tried again
  std::uint64_t write_failures = 0;      ///< the network refused a chunk for good; its message is lost
  std::uint64_t chunks_received = 0;
  std::uint64_t bytes_received = 0;
  std::uint64_t chunks_corrupt = 0;  ///< failed header or CRC32C checks; the sender sends them again
  std::uint64_t messages_received = 0;
  std::uint64_t messages_corrupt = 0;    ///< failed header, order or CRC32C checks
  std::uint64_t messages_lost = 0;       ///< begun but not complete in time, or a number never seen
  std::uint64_t inbox_drops = 0;         ///< received whole, but the reader did not keep up
  std::size_t queued_messages = 0;       ///< now
  std::size_t queued_bytes = 0;          ///< now
  std::size_t unsent_bytes = 0;          ///< queued, and of begun messages what was never sent, now
  std::size_t flying_messages = 0;       ///< begun and not acknowledged, now
  std::size_t flying_bytes = 0;          ///< now
  std::size_t most_queued_messages = 0;  ///< at any time
  std::size_t most_queued_bytes = 0;     ///< at any time
  std::size_t most_flying_messages = 0;  ///< to one peer at any time
  std::size_t most_flying_bytes = 0;     ///< to one peer at any time
};
using LinkCounters = std::array<LaneCounters, kLaneCount>;

/// What an end knows about the way to its peer; from acknowledgements only.
struct LinkQuality {
  std::optional<double> bandwidth_bytes_per_s;  ///< of what this end sends
  std::optional<double> round_trip_ms;          ///< least of the last 2 s
  std::optional<double> shaped_bytes_per_s;  ///< the truth where the link is impaired on purpose; for reports
};

/// One end of a link. Thread-safe. send() and receive() never touch the network: they work on bounded queues.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Queues a message for `robot` and returns at once. False: the message is larger than kMaxMessage_bytes,
  /// empty or not for this end to send; dropped and counted. When the lane is full its oldest message that
  /// has not begun to travel is dropped and counted.
  virtual bool send(Lane lane, map::RobotId robot, std::vector<std::byte> bytes) = 0;
  /// The oldest message that came, waiting up to `timeout` for one; nothing on time-out or after close().
  virtual std::optional<Message> receive(nanoseconds timeout) = 0;
  /// A peer that receives what this end sends is there.
  [[nodiscard]] virtual bool connected() const = 0;
  [[nodiscard]] virtual LinkCounters counters() const = 0;
  /// Takes back the messages of the lane for `robot` (or the server) of which nothing was sent, oldest first.
  virtual std::vector<std::vector<std::byte>> withdraw(Lane /*lane*/, map::RobotId /*robot*/) { return {}; }
  /// Of the lane, for `robot` (or the server), in the queue: nothing of them has begun to travel.
  [[nodiscard]] virtual std::size_t waiting_bytes(Lane /*lane*/, map::RobotId /*robot*/) const { return 0; }
  /// Of the way to `robot`, or to the server.
  [[nodiscard]] virtual LinkQuality quality(map::RobotId /*robot*/) const { return {}; }
  /// A decision depends on the bandwidth: may be measured with padding while nothing else is sent.
  virtual void allow_probing(bool /*allowed*/) {}
  /// What was done to this end's traffic on purpose; nothing where the link is left alone.
  [[nodiscard]] virtual std::optional<ImpairmentCounters> impairments() const { return std::nullopt; }
  /// Waits until everything queued on `lane` was acknowledged or given up, up to `timeout`. True when it was.
  virtual bool drain(Lane lane, nanoseconds timeout) = 0;
  /// Ends waiting calls for good; messages still queued are not sent.
  virtual void close() = 0;
  /// close() was called and every message that had come was taken: receive() will never give one again.
  [[nodiscard]] virtual bool finished() const = 0;
};

}  // namespace edgesplat::link
