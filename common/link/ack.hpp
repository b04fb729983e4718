// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/link/lane.hpp"
#include "common/time/time.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::link {

/// What has come of a message that is not whole yet.
struct PartialTrain {
  std::uint32_t train = 0;
  std::uint32_t first_missing = 0;  ///< all chunks before have come
  std::uint64_t came_bits = 0;      ///< bit i: chunk first_missing + i has come
};
inline constexpr std::size_t kMaxPartialTrains = 16;

/// What a receiver has of one sender's messages on one lane; cumulative, so a lost one does no harm.
struct Ack {
  Lane lane = Lane::kKeyframe;
  std::uint32_t next_train = 1;       ///< all before are settled: received, or given up
  std::uint64_t received_bits = 0;    ///< bit i: next_train + i was received
  std::uint64_t received_total = 0;   ///< since this receiver first heard of the session
  std::uint32_t newest_train = 0;     ///< of the chunk that came last; 0: none yet
  std::uint32_t newest_chunk = 0;     ///< its index
  std::uint32_t newest_attempt = 0;   ///< which sending of it
  std::int64_t newest_came_ns = 0;    ///< by the receiver's clock
  std::vector<PartialTrain> partial;  ///< oldest first, at most kMaxPartialTrains
};

/// All that a receiver has of one sender, lane by lane, and what a bandwidth estimate needs.
struct AckReport {
  std::uint64_t session = 0;          ///< the sender's
  std::uint64_t delivered_bytes = 0;  ///< payload of all bulk chunks that came, repetitions too
  std::int64_t sent_ns = 0;           ///< when this report was made, by the receiver's clock
  std::vector<Ack> lanes;             ///< each lane once
};

[[nodiscard]] std::vector<std::byte> encode_acks(const AckReport& report);
/// kCorrupt for a wrong magic, version, length, a lane that is unknown or named twice, too many parts.
[[nodiscard]] Result<AckReport> decode_acks(std::span<const std::byte> bytes);

/// Remembers which messages of one sender and lane have come: drops repetitions, finds gaps. Pure;
/// single-owner.
class ReceivedTrains {
 public:
  static constexpr std::uint32_t kWindow = 64;

  /// False: that one is settled already, received or given up.
  [[nodiscard]] bool is_new(std::uint32_t train) const;
  void received(std::uint32_t train);
  /// It will not come any more.
  void give_up(std::uint32_t train);
  [[nodiscard]] std::uint32_t next_train() const { return next_; }
  [[nodiscard]] std::uint64_t received_bits() const { return received_; }
  [[nodiscard]] std::uint64_t received_total() const { return received_total_; }
  /// Numbers given up, or passed by because later ones came; a receiver that joins late does not count what
  /// was before it.
  [[nodiscard]] std::uint64_t lost_total() const { return lost_total_; }

 private:
  void make_window_reach(std::uint32_t train);
  void shift_settled();

  std::uint32_t next_ = 1;
  std::uint64_t received_ = 0;  ///< bit i: next_ + i was received
  std::uint64_t given_up_ = 0;  ///< bit i: next_ + i is given up
  std::uint64_t received_total_ = 0;
  std::uint64_t lost_total_ = 0;
};

}  // namespace edgesplat::link
