// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/in_process_transport.hpp"

#include "common/link/in_process_path.hpp"
#include "common/thread/bounded_queue.hpp"

#include <mutex>
#include <utility>

namespace edgesplat::link {
namespace {

using Inbox = thread::BoundedQueue<Message>;

class InProcessTransport final : public Transport {
 public:
  InProcessTransport(Role role, map::RobotId robot, std::shared_ptr<Inbox> mine, std::shared_ptr<Inbox> peers)
      : role_(role), robot_(robot), mine_(std::move(mine)), peers_(std::move(peers)) {}
  ~InProcessTransport() override { close(); }

  bool send(Lane lane, map::RobotId robot, std::vector<std::byte> bytes) override {
    if (lane == Lane::kAck || !sends(role_, lane)) return false;
    const std::size_t size = bytes.size();
    const bool valid = !bytes.empty() && size <= kMaxMessage_bytes && robot == robot_;
    const std::uint64_t session = role_ == Role::kRobot ? 1 : 2;
    const std::lock_guard lock(mutex_);
    LaneCounters& counters = counters_[static_cast<std::size_t>(lane)];
    ++counters.messages_offered;
    if (!valid) {
      ++counters.messages_dropped;
      return false;
    }
    if (peers_->push(Message{lane, robot, session, std::move(bytes)}) != thread::PushResult::kAccepted) {
      ++counters.inbox_drops;
      return false;
    }
    ++counters.messages_sent;
    ++counters.messages_acked;
    ++counters.chunks_sent;
    counters.bytes_sent += size;
    return true;
  }

  std::optional<Message> receive(nanoseconds timeout) override {
    auto message = mine_->pop_for(timeout);
    if (!message) return std::nullopt;
    const std::lock_guard lock(mutex_);
    LaneCounters& counters = counters_[static_cast<std::size_t>(message->lane)];
    ++counters.messages_received;
    ++counters.chunks_received;
    counters.bytes_received += message->bytes.size();
    return message;
  }

  [[nodiscard]] bool connected() const override { return !peers_->finished(); }
  [[nodiscard]] LinkCounters counters() const override {
    const std::lock_guard lock(mutex_);
    return counters_;
  }
  bool drain(Lane, nanoseconds) override { return true; }
  void close() override { mine_->close(); }
  [[nodiscard]] bool finished() const override { return mine_->finished(); }

 private:
  const Role role_;
  const map::RobotId robot_;
  const std::shared_ptr<Inbox> mine_;
  const std::shared_ptr<Inbox> peers_;
  mutable std::mutex mutex_;
  LinkCounters counters_;
};

}  // namespace

InProcessLink make_in_process_link(map::RobotId robot, std::size_t inbox_messages) {
  const thread::QueueLimits limits{inbox_messages};
  auto robots = std::make_shared<Inbox>(limits, thread::Overflow::kDropNewest);
  auto servers = std::make_shared<Inbox>(limits, thread::Overflow::kDropNewest);
  return {std::make_unique<InProcessTransport>(Role::kRobot, robot, robots, servers),
          std::make_unique<InProcessTransport>(Role::kServer, robot, servers, robots)};
}

InProcessEnds make_in_process_ends(LinkEndOptions robot, LinkEndOptions server, const Clock& clock) {
  robot.role = Role::kRobot;
  server.role = Role::kServer;
  InProcessEnds ends{std::make_unique<LinkEnd>(robot, clock), std::make_unique<LinkEnd>(server, clock)};
  InProcessPaths paths = make_in_process_paths(256, ends.robot->waker(), ends.server->waker());
  ends.robot->attach(std::move(paths.robot));
  ends.server->attach(std::move(paths.server));
  return ends;
}

}  // namespace edgesplat::link
