// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/send_queue.hpp"

#include "common/base/crc32c.hpp"

#include <algorithm>
#include <utility>

namespace edgesplat::link {
namespace {

constexpr std::size_t kFirstWindow_bytes = 64 * 1024;  // until set_window() knows better

void note_most(std::size_t& most, std::size_t now) {
  most = std::max(most, now);
}

}  // namespace

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
      to.counters.messages_replaced +=
          std::erase_if(to.queue, [&](const Queued& queued) { return queued.robot == robot; });
      to.bytes = 0;
      for (const Queued& queued : to.queue) to.bytes += queued.bytes.size();
    }
    make_room(to, limits_, bytes.size());
    to.bytes += bytes.size();
    ChunkHeader header;
    header.robot = robot;
    header.session = session_;
    header.count = chunk_count(bytes.size());
    header.total_bytes = static_cast<std::uint32_t>(bytes.size());
    header.message_crc32c = crc;
    to.queue.push_back({robot, std::move(bytes), header});
    note_most(to.counters.most_queued_messages, to.queue.size());
    note_most(to.counters.most_queued_bytes, to.bytes);
    woken_ = true;
  }
  work_.notify_all();
  return true;
}

void SendQueue::make_room(LaneState& lane_state, const SendLimits& limits, std::size_t bytes) {
  auto& queue = lane_state.queue;
  while (!queue.empty() && (queue.size() >= limits.messages || lane_state.bytes + bytes > limits.bytes)) {
    lane_state.bytes -= queue.front().bytes.size();
    queue.pop_front();
    ++lane_state.counters.messages_dropped;
  }
}

SendQueue::Peer& SendQueue::peer(Lane lane, map::RobotId robot) {
  return state(lane).peers.try_emplace(robot, limits_.flight).first->second;
}

std::optional<SendQueue::Part> SendQueue::next(const LaneMask& allowed, HostTime now) {
  const std::lock_guard lock(mutex_);
  chosen_.reset();
  for (const Lane lane : kLanes) {
    if (!allowed[index_of(lane)]) continue;
    auto part = reliable(lane) ? next_of_flights(lane, now) : next_single(lane);
    if (!part && reliable(lane)) part = begin_next(lane, now);
    if (part) return part;
  }
  return std::nullopt;
}

SendQueue::Part SendQueue::chosen(Lane lane, map::RobotId robot, ChunkHeader header,
                                  std::span<const std::byte> payload) {
  header.chunk_crc32c = chunk_crc32c(header, payload);
  chosen_ = Chosen{lane, robot, payload.size()};
  return {lane, header, payload};
}

std::optional<SendQueue::Part> SendQueue::next_single(Lane lane) {
  LaneState& from = state(lane);
  if (!from.single) {
    if (from.queue.empty()) return std::nullopt;
    from.single = std::move(from.queue.front());
    from.queue.pop_front();
    from.bytes -= from.single->bytes.size();
    from.single->header.train = ++peer(lane, from.single->robot).last_train;
  }
  return chosen(lane, from.single->robot, from.single->header, chunk_at(from.single->bytes, 0));
}

std::optional<SendQueue::Part> SendQueue::next_of_flights(Lane lane, HostTime now) {
  for (auto& [robot, to] : state(lane).peers) {
    if (const auto part = to.flight.next(now, window_left(lane, robot))) {
      return chosen(lane, robot, part->header, part->payload);
    }
  }
  return std::nullopt;
}

std::optional<SendQueue::Part> SendQueue::begin_next(Lane lane, HostTime now) {
  LaneState& from = state(lane);
  for (auto queued = from.queue.begin(); queued != from.queue.end(); ++queued) {
    Peer& to = peer(lane, queued->robot);
    if (to.flight.has_unsent() || !to.flight.has_room(queued->bytes.size())) continue;
    const std::size_t window = window_left(lane, queued->robot);
    const std::size_t first = std::min(kChunk_bytes, queued->bytes.size());
    const std::size_t under_way = to.flight.bytes_on_the_way();
    if (under_way + first > window && (under_way > 0 || window == 0)) continue;
    queued->header.train = ++to.last_train;  // only now: what is shed leaves no gap
    const map::RobotId robot = queued->robot;
    from.bytes -= queued->bytes.size();
    to.flight.begin(queued->header, std::move(queued->bytes));
    from.queue.erase(queued);
    note_most(from.counters.most_flying_messages, to.flight.trains());
    note_most(from.counters.most_flying_bytes, to.flight.held_bytes());
    const auto part = to.flight.next(now, window);
    if (!part) return std::nullopt;
    return chosen(lane, robot, part->header, part->payload);
  }
  return std::nullopt;
}

std::size_t SendQueue::window_left(Lane lane, map::RobotId robot) const {
  if (urgent(lane)) return kMaxMessage_bytes;
  const auto found = windows_.find(robot);
  const std::size_t window = found == windows_.end() ? kFirstWindow_bytes : found->second;
  std::size_t others = 0;
  for (const Lane other : kLanes) {
    const auto peer = state(other).peers.find(robot);
    if (other != lane && !urgent(other) && peer != state(other).peers.end()) {
      others += peer->second.flight.bytes_on_the_way();
    }
  }
  const std::size_t left = window - std::min(window, others);
  // Less than a chunk is left for lanes that go first.
  return others > 0 && left < kChunk_bytes ? 0 : left;
}

void SendQueue::sent(HostTime now) {
  const std::lock_guard lock(mutex_);
  if (!chosen_) return;
  const Chosen done = *std::exchange(chosen_, std::nullopt);
  LaneState& from = state(done.lane);
  ++from.counters.chunks_sent;
  from.counters.bytes_sent += done.bytes;
  if (reliable(done.lane)) {
    if (peer(done.lane, done.robot).flight.sent(now)) ++from.counters.messages_sent;
  } else {
    from.single.reset();
    ++from.counters.messages_sent;
  }
}

void SendQueue::count_busy(Lane lane) {
  const std::lock_guard lock(mutex_);
  ++state(lane).counters.write_timeouts;
}

void SendQueue::count_write_failure(Lane lane) {
  const std::lock_guard lock(mutex_);
  ++state(lane).counters.write_failures;
}

void SendQueue::start_over(Lane lane) {
  const std::lock_guard lock(mutex_);
  for (auto& [robot, to] : state(lane).peers) to.flight.start_over();
}

Flight::News SendQueue::on_ack(const Ack& ack, nanoseconds came_after, map::RobotId robot,
                               std::uint64_t receiver_session, HostTime now) {
  Flight::News news;
  {
    const std::lock_guard lock(mutex_);
    const auto found = state(ack.lane).peers.find(robot);
    if (found == state(ack.lane).peers.end()) return news;
    Peer& from = found->second;
    if (from.receiver_session != receiver_session) {
      from.acked_before += from.acked_now;
      from.acked_now = 0;
      if (from.receiver_session != 0) from.flight.start_over();
      from.receiver_session = receiver_session;
    }
    from.acked_now = std::max(from.acked_now, ack.received_total);
    news = from.flight.on_ack(ack, came_after, now);
  }
  drained_.notify_all();
  return news;
}

void SendQueue::set_window(map::RobotId robot, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  windows_[robot] = bytes;
}

bool SendQueue::bulk_waits(map::RobotId robot) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(kLanes.begin(), kLanes.end(), [&](Lane lane) {
    if (urgent(lane) || !reliable(lane)) return false;
    const LaneState& of = state(lane);
    const auto to = of.peers.find(robot);
    if (to != of.peers.end() && to->second.flight.has_unsent()) return true;
    return std::any_of(of.queue.begin(), of.queue.end(),
                       [&](const Queued& queued) { return queued.robot == robot; });
  });
}

std::size_t SendQueue::bulk_bytes_on_the_way(map::RobotId robot) const {
  const std::lock_guard lock(mutex_);
  std::size_t bytes = 0;
  for (const Lane lane : kLanes) {
    const auto to = state(lane).peers.find(robot);
    if (!urgent(lane) && to != state(lane).peers.end()) bytes += to->second.flight.bytes_on_the_way();
  }
  return bytes;
}

std::vector<std::vector<std::byte>> SendQueue::withdraw(Lane lane, map::RobotId robot) {
  std::vector<std::vector<std::byte>> taken;
  {
    const std::lock_guard lock(mutex_);
    LaneState& from = state(lane);
    for (Queued& queued : from.queue) {
      if (queued.robot != robot) continue;
      from.bytes -= queued.bytes.size();
      taken.push_back(std::move(queued.bytes));
    }
    std::erase_if(from.queue, [&](const Queued& queued) { return queued.robot == robot; });
    from.counters.messages_withdrawn += taken.size();
  }
  drained_.notify_all();
  return taken;
}

std::size_t SendQueue::waiting_bytes(Lane lane, map::RobotId robot) const {
  const std::lock_guard lock(mutex_);
  std::size_t bytes = 0;
  for (const Queued& queued : state(lane).queue) bytes += queued.robot == robot ? queued.bytes.size() : 0;
  return bytes;
}

std::optional<HostTime> SendQueue::next_timeout() const {
  const std::lock_guard lock(mutex_);
  std::optional<HostTime> next;
  for (const LaneState& of : lanes_) {
    for (const auto& [robot, to] : of.peers) {
      const auto due = to.flight.next_timeout();
      if (due && (!next || *due < *next)) next = due;
    }
  }
  return next;
}

void SendQueue::wake() {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
  }
  work_.notify_all();
}

void SendQueue::wait_for_work(const std::stop_token& stop, nanoseconds timeout) {
  std::unique_lock lock(mutex_);
  (void)work_.wait_for(lock, stop, timeout, [&] { return woken_; });
  woken_ = false;
}

bool SendQueue::settled(Lane lane) const {
  const LaneState& of = state(lane);
  return of.queue.empty() && std::all_of(of.peers.begin(), of.peers.end(),
                                         [](const auto& entry) { return entry.second.flight.empty(); });
}

bool SendQueue::drain(Lane lane, nanoseconds timeout) {
  std::unique_lock lock(mutex_);
  (void)drained_.wait_for(lock, timeout, [&] { return closed_ || settled(lane); });
  return settled(lane);
}

void SendQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    woken_ = true;
  }
  work_.notify_all();
  drained_.notify_all();
}

LinkCounters SendQueue::counters() const {
  const std::lock_guard lock(mutex_);
  LinkCounters all;
  for (const Lane lane : kLanes) {
    LaneCounters& of = all[index_of(lane)];
    of = state(lane).counters;
    of.queued_messages = state(lane).queue.size();
    of.queued_bytes = state(lane).bytes;
    of.unsent_bytes = state(lane).bytes;
    for (const auto& [robot, to] : state(lane).peers) {
      of.messages_acked += to.acked_before + to.acked_now;
      of.messages_given_up += to.flight.given_up();
      of.chunks_resent += to.flight.resent();
      of.flying_messages += to.flight.trains();
      of.flying_bytes += to.flight.held_bytes();
      of.unsent_bytes += to.flight.unsent_bytes();
    }
  }
  return all;
}

}  // namespace edgesplat::link
