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
  if (!plausible(header, payload.size())) {
    ++of(lane).messages_corrupt;
    return std::nullopt;
  }
  auto message =
      newest_only(lane) ? add_single(lane, header, payload) : add_to_train(lane, header, payload, now);
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

std::optional<Message> ReceiveSide::add_to_train(Lane lane, const ChunkHeader& header,
                                                 std::span<const std::byte> payload, HostTime now) {
  Sender& from = sender({lane, header.robot, header.session}, now);
  if (!from.trains.is_new(header.train)) {
    from.ack_due = true;  // the sender seems not to know
    return std::nullopt;
  }
  const std::uint64_t lost_before = from.trains.lost_total();
  TrainAssembler::Added added = from.assembler.add(header, payload, now);
  for (const std::uint32_t train : added.lost_trains) from.trains.give_up(train);
  if (added.outcome == TrainAssembler::Outcome::kCorrupt) {
    ++of(lane).messages_corrupt;
    return std::nullopt;
  }
  std::optional<Message> message;
  if (added.outcome == TrainAssembler::Outcome::kComplete) {
    from.trains.received(header.train);
    from.ack_due = true;
    message = Message{lane, header.robot, header.session, std::move(added.message)};
  }
  of(lane).messages_lost += from.trains.lost_total() - lost_before;
  return message;
}

ReceiveSide::Sender& ReceiveSide::sender(const SenderKey& key, HostTime now) {
  auto found = senders_.find(key);
  if (found == senders_.end()) {
    if (senders_.size() >= limits_.senders) {
      const auto oldest =
          std::min_element(senders_.begin(), senders_.end(),
                           [](const auto& a, const auto& b) { return a.second.touched < b.second.touched; });
      of(std::get<Lane>(oldest->first)).messages_lost += oldest->second.assembler.trains();
      senders_.erase(oldest);
    }
    found = senders_.try_emplace(key, limits_.assembler).first;
  }
  found->second.touched = now;
  return found->second;
}

void ReceiveSide::expire(HostTime now) {
  const std::lock_guard lock(counters_mutex_);
  for (auto& [key, from] : senders_) {
    const std::uint64_t lost_before = from.trains.lost_total();
    for (const std::uint32_t train : from.assembler.expire(now)) {
      from.trains.give_up(train);
      from.ack_due = true;
    }
    of(std::get<Lane>(key)).messages_lost += from.trains.lost_total() - lost_before;
  }
}

std::vector<ReceiveSide::DueAck> ReceiveSide::take_due_acks() {
  std::vector<DueAck> due;
  for (auto& [key, from] : senders_) {
    if (!std::exchange(from.ack_due, false)) continue;
    const auto& [lane, robot, session] = key;
    due.push_back({robot, Ack{lane, session, from.trains.next_train(), from.trains.received_bits(),
                              from.trains.received_total()}});
  }
  return due;
}

LinkCounters ReceiveSide::counters() const {
  const std::lock_guard lock(counters_mutex_);
  return counters_;
}

}  // namespace edgesplat::link
