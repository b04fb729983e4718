// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/result.hpp"
#include "common/link/lane.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgesplat::link {

/// What a receiver has of one sender's messages on one lane; cumulative, so a lost one does no harm.
struct Ack {
  Lane lane = Lane::kKeyframe;
  std::uint64_t session = 0;         ///< the sender's
  std::uint32_t next_train = 1;      ///< all before are settled: received, or given up
  std::uint64_t received_bits = 0;   ///< bit i: next_train + i was received
  std::uint64_t received_total = 0;  ///< since this receiver first heard of the session
};

[[nodiscard]] std::vector<std::byte> encode_ack(const Ack& ack);
/// kCorrupt for a wrong magic, version, length or lane.
[[nodiscard]] Result<Ack> decode_ack(std::span<const std::byte> bytes);

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
