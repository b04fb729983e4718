// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robot/drivers/livox/livox_packet.hpp"

#include <array>
#include <cstdint>

namespace edgesplat::livox {

/// What went wrong on one channel.
struct StreamCounters {
  std::uint64_t packets = 0;        ///< used
  std::uint64_t lost = 0;           ///< holes in the packet numbers (SDK1: in the stamps)
  std::uint64_t stamp_gaps = 0;     ///< silences > 1.5 packets that no lost packet explains
  std::uint64_t duplicate = 0;      ///< seen before, not used
  std::uint64_t reordered = 0;      ///< overtaken on the way, by less than 1 ms: used
  std::uint64_t bad_stamp = 0;      ///< stamp > 1 ms back or > 1 s off: not used
  std::uint64_t clock_changes = 0;  ///< the device's clock got another source or restarted
};

/// Watches numbers and stamps of one channel (points or IMU) and decides which packets are used. After a
/// restart of the device its stamps start anew: kAgreeingForRestart packets in a row that agree with each
/// other are believed. Single-owner, no allocation.
class StreamMonitor {
 public:
  static constexpr int kAgreeingForRestart = 10;

  /// True if the packet is to be used.
  [[nodiscard]] bool accept(const PacketTiming& packet, HostTime arrival);
  [[nodiscard]] const StreamCounters& counters() const { return counters_; }

 private:
  struct Seen {
    std::int64_t stamp_ns = -1;
    std::uint16_t udp_count = 0;
  };
  [[nodiscard]] bool was_seen(const PacketTiming& packet) const;
  [[nodiscard]] bool stamp_is_sane(const PacketTiming& packet, HostTime arrival);
  void count_holes(const PacketTiming& packet);
  void count_missing_stamps(const PacketTiming& packet);
  void remember(const PacketTiming& packet);
  void restart(const PacketTiming& packet, HostTime arrival);

  StreamCounters counters_;
  bool started_ = false;
  sensor::StampSource source_ = sensor::StampSource::kFreeRunning;
  std::int64_t newest_stamp_ns_ = 0;
  std::int64_t newest_arrival_ns_ = 0;
  std::int64_t newest_span_ns_ = 0;
  std::int64_t newest_period_ns_ = 0;
  std::uint16_t newest_count_ = 0;
  std::uint8_t newest_frame_ = 0;
  std::array<Seen, 32> recent_{};
  std::size_t recent_next_ = 0;
  int agreeing_ = 0;  ///< refused packets in a row that agree with each other
  std::int64_t candidate_stamp_ns_ = 0;
  std::int64_t candidate_arrival_ns_ = 0;
};

}  // namespace edgesplat::livox
