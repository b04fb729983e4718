// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/drivers/livox/stream_monitor.hpp"

#include <cmath>

namespace edgesplat::livox {
namespace {

constexpr std::int64_t kMaxBack_ns = 1'000'000;
constexpr double kMaxJump_ns = 1e9;
constexpr std::uint16_t kMaxHole = 8192;  // 4 s of points; a wider step is a counter that started anew

/// What passed between two moments; as double because arrivals from a recording may be any number.
double passed_ns(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns) - static_cast<double>(from_ns);
}

}  // namespace

bool StreamMonitor::accept(const PacketTiming& packet, HostTime arrival) {
  const bool source_changed = started_ && packet.stamp_source != source_;
  if (source_changed) ++counters_.clock_changes;
  if (!started_ || source_changed) {
    restart(packet, arrival);
    ++counters_.packets;
    return true;
  }
  if (was_seen(packet)) {
    ++counters_.duplicate;
    return false;
  }
  if (!stamp_is_sane(packet, arrival)) {
    ++counters_.bad_stamp;
    return false;
  }
  ++counters_.packets;
  const std::int64_t stamp_ns = to_ns(packet.stamp);
  if (stamp_ns < newest_stamp_ns_) {
    ++counters_.reordered;
    if (counters_.lost > 0) --counters_.lost;  // it was counted as a hole when its successor came
    remember(packet);
    return true;
  }
  count_holes(packet);
  remember(packet);
  newest_stamp_ns_ = stamp_ns;
  newest_arrival_ns_ = to_ns(arrival);
  newest_span_ns_ = packet.span.count();
  newest_period_ns_ = packet.period.count();
  newest_count_ = packet.udp_count;
  newest_frame_ = packet.frame_count;
  return true;
}

bool StreamMonitor::was_seen(const PacketTiming& packet) const {
  const std::int64_t stamp_ns = to_ns(packet.stamp);
  if (stamp_ns > newest_stamp_ns_) return false;
  for (const Seen& seen : recent_)
    if (seen.stamp_ns == stamp_ns && seen.udp_count == packet.udp_count) return true;
  return false;
}

/// Sane: not more than 1 ms back and, given the time that passed here, not more than 1 s off.
bool StreamMonitor::stamp_is_sane(const PacketTiming& packet, HostTime arrival) {
  const std::int64_t stamp_ns = to_ns(packet.stamp);
  const std::int64_t arrival_ns = to_ns(arrival);
  const std::int64_t step_ns = stamp_ns - newest_stamp_ns_;
  const double off_ns = static_cast<double>(step_ns) - passed_ns(newest_arrival_ns_, arrival_ns);
  if (step_ns >= -kMaxBack_ns && std::abs(off_ns) <= kMaxJump_ns) {
    agreeing_ = 0;
    return true;
  }
  const std::int64_t candidate_step_ns = stamp_ns - candidate_stamp_ns_;
  const double candidate_off_ns =
      static_cast<double>(candidate_step_ns) - passed_ns(candidate_arrival_ns_, arrival_ns);
  const bool agrees = agreeing_ > 0 && candidate_step_ns > 0 && std::abs(candidate_off_ns) <= kMaxJump_ns;
  agreeing_ = agrees ? agreeing_ + 1 : 1;
  candidate_stamp_ns_ = stamp_ns;
  candidate_arrival_ns_ = arrival_ns;
  if (agreeing_ < kAgreeingForRestart) return false;
  ++counters_.clock_changes;
  restart(packet, arrival);
  return true;
}

void StreamMonitor::count_holes(const PacketTiming& packet) {
  if (!packet.is_numbered) {
    count_missing_stamps(packet);
    return;
  }
  const auto step = static_cast<std::uint16_t>(packet.udp_count - newest_count_);
  const bool new_frame = packet.udp_count == 0 && packet.frame_count != newest_frame_;
  const bool has_hole = step > 1 && step <= kMaxHole && !new_frame;
  if (has_hole) counters_.lost += static_cast<std::uint64_t>(step - 1);
  const std::int64_t silence_ns = to_ns(packet.stamp) - newest_stamp_ns_;
  const bool silent = newest_span_ns_ > 0 && silence_ns * 2 > newest_span_ns_ * 3;
  if (silent && !has_hole) ++counters_.stamp_gaps;
}

/// Packets follow each other without a pause, so a hole of n periods lacks n packets. A longer silence is the
/// device's, not the wire's.
void StreamMonitor::count_missing_stamps(const PacketTiming& packet) {
  if (newest_period_ns_ <= 0) return;
  const std::int64_t missing =
      (to_ns(packet.stamp) - newest_stamp_ns_ + newest_period_ns_ / 2) / newest_period_ns_ - 1;
  if (missing > kMaxHole) ++counters_.stamp_gaps;
  if (missing > 0 && missing <= kMaxHole) counters_.lost += static_cast<std::uint64_t>(missing);
}

void StreamMonitor::remember(const PacketTiming& packet) {
  recent_[recent_next_] = {to_ns(packet.stamp), packet.udp_count};
  recent_next_ = (recent_next_ + 1) % recent_.size();
}

void StreamMonitor::restart(const PacketTiming& packet, HostTime arrival) {
  started_ = true;
  agreeing_ = 0;
  source_ = packet.stamp_source;
  recent_.fill({});
  remember(packet);
  newest_stamp_ns_ = to_ns(packet.stamp);
  newest_arrival_ns_ = to_ns(arrival);
  newest_span_ns_ = packet.span.count();
  newest_period_ns_ = packet.period.count();
  newest_count_ = packet.udp_count;
  newest_frame_ = packet.frame_count;
}

}  // namespace edgesplat::livox
