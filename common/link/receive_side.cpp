// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/receive_side.hpp"

#include "common/base/crc32c.hpp"

#include <algorithm>

namespace edgesplat::link {

std::optional<Message> ReceiveSide::add(Lane lane, const ChunkHeader& header,
                                        std::span<const std::byte> payload, HostTime now) {
  const std::lock_guard lock(counters_mutex_);
  ++of(lane).chunks_received;
  of(lane).bytes_received += payload.size();
  if (!plausible(header, payload.size()) || chunk_crc32c(header, payload) != header.chunk_crc32c) {
    ++of(lane).chunks_corrupt;
    return std::nullopt;
  }
  std::optional<Message> message;
  if (lane == Lane::kAck) {  // nobody acknowledges acknowledgements
    message = add_single(lane, header, payload);
  } else {
    Sender& from = sender({header.robot, header.session}, now);
    auto& side = from.lanes[index_of(lane)];
    if (!side) side.emplace(limits_.assembler);
    side->newest_train = header.train;
    side->newest_chunk = header.index;
    side->newest_attempt = header.attempt;
    side->newest_came = now;
    from.ack_due = true;
    if (!urgent(lane)) from.delivered_bytes += payload.size();
    message =
        reliable(lane) ? add_to_train(lane, *side, header, payload, now) : add_single(lane, header, payload);
  }
  if (message) ++of(lane).messages_received;
  return message;
}

std::optional<Message> ReceiveSide::add_single(Lane lane, const ChunkHeader& header,
                                               std::span<const std::byte> payload) {
  if (header.count != 1 || crc32c(payload) != header.message_crc32c) {
    ++of(lane).messages_corrupt;
    return std::nullopt;
  }
  return Message{lane, header.robot, header.session, {payload.begin(), payload.end()}};
}

std::optional<Message> ReceiveSide::add_to_train(Lane lane, LaneSide& side, const ChunkHeader& header,
                                                 std::span<const std::byte> payload, HostTime now) {
  if (!side.trains.is_new(header.train))
    return std::nullopt;  // the sender seems not to know: acknowledged again
  const std::uint64_t lost_before = side.trains.lost_total();
  TrainAssembler::Added added = side.assembler.add(header, payload, now);
  for (const std::uint32_t train : added.lost_trains) side.trains.give_up(train);
  std::optional<Message> message;
  if (added.outcome == TrainAssembler::Outcome::kCorrupt) {
    ++of(lane).messages_corrupt;
  } else if (added.outcome == TrainAssembler::Outcome::kComplete) {
    side.trains.received(header.train);
    message = Message{lane, header.robot, header.session, std::move(added.message)};
  }
  of(lane).messages_lost += side.trains.lost_total() - lost_before;
  return message;
}

ReceiveSide::Sender& ReceiveSide::sender(const SenderKey& key, HostTime now) {
  auto found = senders_.find(key);
  if (found == senders_.end()) {
    if (senders_.size() >= limits_.senders) {
      const auto oldest =
          std::min_element(senders_.begin(), senders_.end(),
                           [](const auto& a, const auto& b) { return a.second.touched < b.second.touched; });
      for (const Lane lane : kLanes) {
        const auto& side = oldest->second.lanes[index_of(lane)];
        if (side) of(lane).messages_lost += side->assembler.trains();
      }
      senders_.erase(oldest);
    }
    found = senders_.try_emplace(key).first;
  }
  found->second.touched = now;
  return found->second;
}

void ReceiveSide::expire(HostTime now) {
  const std::lock_guard lock(counters_mutex_);
  for (auto& [key, from] : senders_) {
    for (const Lane lane : kLanes) {
      auto& side = from.lanes[index_of(lane)];
      if (!side) continue;
      const std::uint64_t lost_before = side->trains.lost_total();
      for (const std::uint32_t train : side->assembler.expire(now)) {
        side->trains.give_up(train);
        from.ack_due = true;
      }
      of(lane).messages_lost += side->trains.lost_total() - lost_before;
    }
  }
}

Ack ReceiveSide::ack_of(Lane lane, const LaneSide& side) {
  Ack ack;
  ack.lane = lane;
  ack.next_train = side.trains.next_train();
  ack.received_bits = side.trains.received_bits();
  ack.received_total = side.trains.received_total();
  ack.newest_train = side.newest_train;
  ack.newest_chunk = side.newest_chunk;
  ack.newest_attempt = side.newest_attempt;
  ack.newest_came_ns = to_ns(side.newest_came);
  ack.partial = side.assembler.partial(kMaxPartialTrains);
  return ack;
}

std::vector<ReceiveSide::DueAck> ReceiveSide::take_due_acks(HostTime now) {
  std::vector<DueAck> due;
  for (auto& [key, from] : senders_) {
    if (!std::exchange(from.ack_due, false)) continue;
    AckReport report;
    report.session = key.second;
    report.delivered_bytes = from.delivered_bytes;
    report.sent_ns = to_ns(now);
    for (const Lane lane : kLanes) {
      const auto& side = from.lanes[index_of(lane)];
      if (side) report.lanes.push_back(ack_of(lane, *side));
    }
    due.push_back({key.first, std::move(report)});
  }
  return due;
}

LinkCounters ReceiveSide::counters() const {
  const std::lock_guard lock(counters_mutex_);
  return counters_;
}

}  // namespace edgesplat::link
