// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/send_queue.hpp"

#include "common/base/crc32c.hpp"

#include <algorithm>

namespace edgesplat::link {

bool SendQueue::push(Lane lane, map::RobotId robot, std::vector<std::byte> bytes) {
  const std::uint32_t crc = crc32c(bytes);
  {
    const std::lock_guard lock(mutex_);
    LaneState& to = state(lane);
    ++to.counters.messages_offered;
    if (closed_ || bytes.empty() || bytes.size() > std::min(kMaxMessage_bytes, limits_.bytes)) {
      ++to.counters.messages_dropped;
      return false;
    }
    if (newest_only(lane)) {
      const auto replaced =
          std::erase_if(to.queue, [&](const Queued& q) { return q.robot == robot && !q.begun; });
      to.counters.messages_replaced += replaced;
      to.bytes = 0;
      for (const Queued& queued : to.queue) to.bytes += queued.bytes.size();
    }
    make_room(to, bytes.size());
    to.bytes += bytes.size();
    ChunkHeader header;
    header.robot = robot;
    header.session = session_;
    header.count = chunk_count(bytes.size());
    header.total_bytes = static_cast<std::uint32_t>(bytes.size());
    header.message_crc32c = crc;
    to.queue.push_back({robot, std::move(bytes), header, false});
  }
  work_.notify_all();
  return true;
}

void SendQueue::make_room(LaneState& lane_state, std::size_t bytes) {
  auto& queue = lane_state.queue;
  // A train that has begun to travel is left to arrive; what waits behind it goes first-come first-dropped.
  while (!queue.empty() && (queue.size() >= limits_.messages || lane_state.bytes + bytes > limits_.bytes)) {
    const auto oldest = std::find_if(queue.begin(), queue.end(), [](const Queued& q) { return !q.begun; });
    if (oldest == queue.end()) return;
    lane_state.bytes -= oldest->bytes.size();
    queue.erase(oldest);
    ++lane_state.counters.messages_dropped;
  }
}

std::optional<SendQueue::Part> SendQueue::next(const LaneMask& allowed) {
  const std::lock_guard lock(mutex_);
  for (const Lane lane : kLanes) {
    LaneState& from = state(lane);
    if (!allowed[static_cast<std::size_t>(lane)] || from.queue.empty()) continue;
    Queued& front = from.queue.front();
    if (!front.begun) {
      front.begun = true;
      front.header.train = ++peers_[{lane, front.robot}].last_train;  // only now: what is shed leaves no gap
    }
    return Part{lane, front.header, chunk_at(front.bytes, front.header.index)};
  }
  return std::nullopt;
}

void SendQueue::advance(Lane lane) {
  const std::lock_guard lock(mutex_);
  LaneState& from = state(lane);
  Queued& front = from.queue.front();
  ++from.counters.chunks_sent;
  from.counters.bytes_sent += chunk_at(front.bytes, front.header.index).size();
  if (++front.header.index < front.header.count) return;
  ++from.counters.messages_sent;
  from.bytes -= front.bytes.size();
  from.queue.pop_front();
  if (from.queue.empty()) drained_.notify_all();
}

void SendQueue::count_write_timeout(Lane lane) {
  const std::lock_guard lock(mutex_);
  ++state(lane).counters.write_timeouts;
}

void SendQueue::count_write_failure(Lane lane) {
  const std::lock_guard lock(mutex_);
  ++state(lane).counters.write_failures;
}

void SendQueue::rewind(Lane lane) {
  const std::lock_guard lock(mutex_);
  LaneState& of = state(lane);
  if (!of.queue.empty()) of.queue.front().header.index = 0;
}

void SendQueue::on_ack(const Ack& ack, map::RobotId robot, std::uint64_t receiver_session) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = peers_.find({ack.lane, robot});
    if (ack.session != session_ || found == peers_.end()) return;
    Peer& peer = found->second;
    if (peer.receiver_session != receiver_session) {
      peer.acked_before += peer.acked_now;
      peer.acked_now = 0;
      peer.receiver_session = receiver_session;
    }
    peer.acked_now = std::max(peer.acked_now, ack.received_total);
  }
  drained_.notify_all();
}

void SendQueue::wake() {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
  }
  work_.notify_all();
}

bool SendQueue::has_work(const LaneMask& allowed) const {
  return std::any_of(kLanes.begin(), kLanes.end(), [&](Lane lane) {
    return allowed[static_cast<std::size_t>(lane)] && !state(lane).queue.empty();
  });
}

void SendQueue::wait_for_work(const LaneMask& allowed, const std::stop_token& stop, nanoseconds timeout) {
  std::unique_lock lock(mutex_);
  (void)work_.wait_for(lock, stop, timeout, [&] { return woken_ || has_work(allowed); });
  woken_ = false;
}

std::uint64_t SendQueue::acked(Lane lane) const {
  std::uint64_t total = 0;
  for (const auto& [key, peer] : peers_) {
    if (key.first == lane) total += peer.acked_before + peer.acked_now;
  }
  return total;
}

bool SendQueue::drain(Lane lane, nanoseconds timeout) {
  std::unique_lock lock(mutex_);
  const LaneState& of = state(lane);
  const auto all_acked = [&] { return of.queue.empty() && acked(lane) >= of.counters.messages_sent; };
  (void)drained_.wait_for(lock, timeout, [&] { return closed_ || all_acked(); });
  return all_acked();
}

void SendQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  work_.notify_all();
  drained_.notify_all();
}

LinkCounters SendQueue::counters() const {
  const std::lock_guard lock(mutex_);
  LinkCounters all;
  for (const Lane lane : kLanes) {
    LaneCounters& of = all[static_cast<std::size_t>(lane)];
    of = state(lane).counters;
    of.messages_acked = acked(lane);
    of.queued_messages = state(lane).queue.size();
    of.queued_bytes = state(lane).bytes;
  }
  return all;
}

}  // namespace edgesplat::link
