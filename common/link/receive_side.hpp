// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/ack.hpp"
#include "common/link/train.hpp"
#include "common/link/transport.hpp"

#include <map>
#include <mutex>
#include <optional>
#include <tuple>
#include <vector>

namespace edgesplat::link {

struct ReceiveLimits {
  std::size_t senders = 16;  ///< sessions remembered; over it the one silent for longest is forgotten
  AssemblerLimits assembler;
};

/// Turns chunks that came in into whole messages, each at most once, and into acknowledgements. Pure; one
/// thread feeds it, counters() is thread-safe.
class ReceiveSide {
 public:
  struct DueAck {
    map::RobotId robot;
    Ack ack;
  };

  explicit ReceiveSide(const ReceiveLimits& limits = {}) : limits_(limits) {}

  /// A message once it is whole. On newest_only lanes a message is one chunk and repetitions pass.
  std::optional<Message> add(Lane lane, const ChunkHeader& header, std::span<const std::byte> payload,
                             HostTime now);
  /// Gives up messages that stand unfinished for too long.
  void expire(HostTime now);
  /// What to tell the senders since the last call.
  std::vector<DueAck> take_due_acks();
  /// Only the fields about receiving are filled in.
  [[nodiscard]] LinkCounters counters() const;

 private:
  using SenderKey = std::tuple<Lane, map::RobotId, std::uint64_t>;
  struct Sender {
    explicit Sender(const AssemblerLimits& limits) : assembler(limits) {}
    TrainAssembler assembler;
    ReceivedTrains trains;
    HostTime touched{};
    bool ack_due = false;
  };
  Sender& sender(const SenderKey& key, HostTime now);
  std::optional<Message> add_single(Lane lane, const ChunkHeader& header, std::span<const std::byte> payload);
  std::optional<Message> add_to_train(Lane lane, const ChunkHeader& header,
                                      std::span<const std::byte> payload, HostTime now);
  LaneCounters& of(Lane lane) { return counters_[static_cast<std::size_t>(lane)]; }

  ReceiveLimits limits_;
  std::map<SenderKey, Sender> senders_;
  mutable std::mutex counters_mutex_;
  LinkCounters counters_;
};

}  // namespace edgesplat::link
