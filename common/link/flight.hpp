// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/ack.hpp"
#include "common/link/train.hpp"

#include <deque>
#include <optional>
#include <vector>

namespace edgesplat::link {

struct FlightLimits {
  std::size_t trains = 32;  ///< begun and not acknowledged; half of ReceivedTrains::kWindow
  std::size_t bytes = std::size_t{16} << 20U;           ///< the same; one message passes whatever its size
  std::uint32_t tries = 8;                              ///< of one chunk; then its message is given up
  nanoseconds first_timeout = std::chrono::seconds(1);  ///< without any answer, before the first
  nanoseconds first_least_timeout = std::chrono::milliseconds(200);  ///< costs one repetition at most
  nanoseconds least_timeout = std::chrono::seconds(1);               ///< of the second in a row
  nanoseconds most_timeout = std::chrono::seconds(3);
  nanoseconds reordering = std::chrono::milliseconds(20);  ///< a later chunk may overtake by this much
};

/// The messages of one lane that are begun and not acknowledged by one peer: what to send first, what to send
/// again. A chunk counts as lost once one that was sent later has come (RFC 8985), or when nothing was heard
/// for a time-out that doubles (RFC 6298). Pure; single-owner.
class Flight {
 public:
  struct Part {
    ChunkHeader header;
    std::span<const std::byte> payload;  ///< valid until the next call that is not const
  };
  /// What an acknowledgement told.
  struct News {
    std::size_t chunks_came = 0;
    std::size_t chunks_lost = 0;            ///< newly known to be lost, since the last news
    std::optional<HostTime> newest_sent;    ///< when the newest chunk was sent
    std::optional<nanoseconds> round_trip;  ///< of it
  };

  explicit Flight(const FlightLimits& limits = {}) : limits_(limits) {}

  /// There is room to begin a message of `bytes`.
  [[nodiscard]] bool has_room(std::size_t bytes) const;
  /// Begins a message. `header` as of its first chunk.
  void begin(const ChunkHeader& header, std::vector<std::byte> message);

  /// The chunk to send now: again where one is lost, else the next that never was. Nothing new once
  /// `window_bytes` are on their way; one chunk may always be, but for a window of 0. The same again until
  /// sent().
  std::optional<Part> next(HostTime now, std::size_t window_bytes);
  /// What next() gave is sent. True when with it the whole message is sent for the first time.
  bool sent(HostTime now);
  /// `came_after`: how long the receiver had the newest chunk before it told.
  News on_ack(const Ack& ack, nanoseconds came_after, HostTime now);
  /// The receiver is a new one or lost what it had: everything goes out again.
  void start_over();

  /// When next() may have something without an acknowledgement before.
  [[nodiscard]] std::optional<HostTime> next_timeout() const;
  [[nodiscard]] bool empty() const { return trains_.empty(); }
  [[nodiscard]] bool has_unsent() const;
  [[nodiscard]] std::size_t bytes_on_the_way() const { return bytes_on_the_way_; }
  /// Of begun messages, what was not sent even once.
  [[nodiscard]] std::size_t unsent_bytes() const;
  [[nodiscard]] std::size_t held_bytes() const { return held_bytes_; }
  [[nodiscard]] std::size_t trains() const { return trains_.size(); }
  [[nodiscard]] std::uint64_t given_up() const { return given_up_; }
  [[nodiscard]] std::uint64_t resent() const { return resent_; }

 private:
  struct Chunk {
    HostTime first_sent_at{};
    HostTime sent_at{};
    std::uint64_t order = 0;  ///< of the last sending among all
    std::uint32_t tries = 0;
    bool came = false;
    bool lost = false;
  };
  struct Train {
    ChunkHeader header;
    std::vector<std::byte> message;
    std::vector<Chunk> chunks;
    std::uint32_t next_unsent = 0;
  };
  struct Choice {
    std::uint32_t train = 0;
    std::uint32_t chunk = 0;
  };
  [[nodiscard]] Train* find(std::uint32_t number);
  [[nodiscard]] std::optional<Choice> choose(std::size_t window_bytes);
  [[nodiscard]] std::size_t size_of(const Train& train, std::uint32_t chunk) const;
  void came(Train& train, std::uint32_t chunk, HostTime now, News& news);
  void lose(Train& train, std::uint32_t chunk);
  void note_newest(const Ack& ack, nanoseconds came_after, HostTime now, News& news);
  /// Chunks that a later one overtook longer ago than reordering explains.
  void find_lost(HostTime now);
  [[nodiscard]] bool overtaken(const Chunk& chunk) const;
  [[nodiscard]] HostTime lost_at(const Chunk& chunk) const;
  [[nodiscard]] std::optional<HostTime> silence_ends() const;
  void check_timeout(HostTime now);
  void learn_round_trip(nanoseconds sample);
  [[nodiscard]] nanoseconds timeout() const;
  void remove_exhausted();
  void remove(std::size_t index);

  FlightLimits limits_;
  std::deque<Train> trains_;
  std::optional<Choice> chosen_;
  std::size_t bytes_on_the_way_ = 0;
  std::size_t held_bytes_ = 0;
  std::uint64_t sendings_ = 0;
  std::uint64_t newest_came_order_ = 0;
  nanoseconds newest_round_trip_{};  ///< of the chunk that came with that order
  std::size_t lost_not_told_ = 0;
  std::optional<HostTime> progress_at_;  ///< when something was last heard or first sent
  std::optional<nanoseconds> smooth_round_trip_;
  nanoseconds round_trip_deviation_{};
  int timeouts_in_a_row_ = 0;
  std::uint64_t given_up_ = 0;
  std::uint64_t resent_ = 0;
};

}  // namespace edgesplat::link
