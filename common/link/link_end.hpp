// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/link/chunk_path.hpp"
#include "common/link/impaired_path.hpp"
#include "common/link/peer_link.hpp"
#include "common/link/receive_side.hpp"
#include "common/link/send_queue.hpp"
#include "common/link/transport.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"
#include "common/time/clock.hpp"

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace edgesplat::link {

struct LinkEndOptions {
  Role role = Role::kRobot;
  map::RobotId robot{1};      ///< this robot; the server ignores it
  std::uint64_t session = 1;  ///< must differ after a restart
  SendLimits send;
  std::size_t inbox_messages = 32;
  ImpairmentConfig impair;
  BandwidthConfig bandwidth;
  ProbeConfig probe;
  std::string name = "in process";  ///< for the log
};

/// One end of a link over any chunk path: queues, acknowledgements, repetition of what was lost, bandwidth.
/// With start() a thread of its own runs it, which alone touches the path; without, the owner calls step(),
/// so that tests run in virtual time. `clock` must outlive it.
class LinkEnd final : public Transport {
 public:
  LinkEnd(const LinkEndOptions& options, const Clock& clock);
  ~LinkEnd() override { close(); }

  /// To be called by a path when data or peers came or went; from any thread.
  [[nodiscard]] std::function<void()> waker();
  /// Before anything else is called. Made worse on purpose where the options say so, which is logged.
  void attach(std::unique_ptr<ChunkPath> path);
  void start();
  /// Does all there is to do now. Returns how long one may sleep when nobody wakes it.
  nanoseconds step();

  bool send(Lane lane, map::RobotId robot, std::vector<std::byte> bytes) override;
  std::optional<Message> receive(nanoseconds timeout) override;
  [[nodiscard]] bool connected() const override { return connected_.load(); }
  [[nodiscard]] LinkCounters counters() const override;
  std::vector<std::vector<std::byte>> withdraw(Lane lane, map::RobotId robot) override {
    return sending_.withdraw(lane, robot);
  }
  [[nodiscard]] std::size_t waiting_bytes(Lane lane, map::RobotId robot) const override {
    return sending_.waiting_bytes(lane, robot);
  }
  [[nodiscard]] LinkQuality quality(map::RobotId robot) const override;
  void allow_probing(bool allowed) override;
  [[nodiscard]] std::optional<ImpairmentCounters> impairments() const override;
  bool drain(Lane lane, nanoseconds timeout) override { return sending_.drain(lane, timeout); }
  void close() override;
  [[nodiscard]] bool finished() const override { return inbox_.finished(); }

 private:
  void take_what_came();
  [[nodiscard]] bool has_room() const { return inbox_.size() < options_.inbox_messages; }
  void deliver(Message message);
  void on_acks(const Message& message);
  void queue_acks();
  LaneMask reachable_lanes();
  /// True when it stopped though there is more to send.
  bool send_chunks(const LaneMask& reachable);
  void send_probes(const LaneMask& reachable);
  void send_probe(map::RobotId robot, PeerLink& peer, HostTime now);
  void look_after_peers(HostTime now);
  [[nodiscard]] nanoseconds time_to_sleep(HostTime now) const;
  /// Nothing where there are too many robots to keep book of.
  PeerLink* peer(map::RobotId robot);
  [[nodiscard]] std::size_t bytes_on_the_way(map::RobotId robot, const PeerLink& peer, HostTime now) const;

  const LinkEndOptions options_;
  const Clock& clock_;
  SendQueue sending_;
  ReceiveSide receiving_;
  thread::BoundedQueue<Message> inbox_;
  std::atomic<bool> connected_ = false;
  std::atomic<bool> probing_allowed_ = false;
  std::atomic<std::uint64_t> inbox_drops_ = 0;
  mutable std::mutex shown_mutex_;  ///< what other threads ask for
  std::map<map::RobotId, LinkQuality> shown_qualities_;
  std::optional<ImpairmentCounters> shown_impairments_;
  LaneCounters shown_probes_;
  // From here on the link thread's own.
  std::map<map::RobotId, PeerLink> peers_;
  LaneMask reachable_before_{};
  HostTime expired_at_{};
  std::uint32_t last_probe_ = 0;
  LaneCounters probes_;
  std::unique_ptr<ChunkPath> path_;
  ImpairedPath* impaired_ = nullptr;  ///< the same as path_, where it is one
  std::optional<thread::Worker> link_thread_;
};

}  // namespace edgesplat::link
