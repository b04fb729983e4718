// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/ack.hpp"
#include "common/link/train.hpp"
#include "common/link/transport.hpp"

#include <array>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
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
    AckReport report;
  };

  explicit ReceiveSide(const ReceiveLimits& limits = {}) : limits_(limits) {}

  /// A message once it is whole. On lanes that are not reliable a message is one chunk and repetitions pass.
  std::optional<Message> add(Lane lane, const ChunkHeader& header, std::span<const std::byte> payload,
                             HostTime now);
  /// Gives up messages that stand unfinished for too long.
  void expire(HostTime now);
  /// What to tell the senders that something came from since the last call.
  std::vector<DueAck> take_due_acks(HostTime now);
  /// Only the fields about receiving are filled in.
  [[nodiscard]] LinkCounters counters() const;

 private:
  using SenderKey = std::pair<map::RobotId, std::uint64_t>;
  struct LaneSide {
    explicit LaneSide(const AssemblerLimits& limits) : assembler(limits) {}
    TrainAssembler assembler;
    ReceivedTrains trains;
    std::uint32_t newest_train = 0;
    std::uint32_t newest_chunk = 0;
    std::uint32_t newest_attempt = 0;
    HostTime newest_came{};
  };
  struct Sender {
    std::array<std::optional<LaneSide>, kLaneCount> lanes;
    std::uint64_t delivered_bytes = 0;
    HostTime touched{};
    bool ack_due = false;
  };
  Sender& sender(const SenderKey& key, HostTime now);
  std::optional<Message> add_single(Lane lane, const ChunkHeader& header, std::span<const std::byte> payload);
  std::optional<Message> add_to_train(Lane lane, LaneSide& side, const ChunkHeader& header,
                                      std::span<const std::byte> payload, HostTime now);
  static Ack ack_of(Lane lane, const LaneSide& side);
  LaneCounters& of(Lane lane) { return counters_[index_of(lane)]; }

  ReceiveLimits limits_;
  std::map<SenderKey, Sender> senders_;
  mutable std::mutex counters_mutex_;
  LinkCounters counters_;
};

}  // namespace edgesplat::link
