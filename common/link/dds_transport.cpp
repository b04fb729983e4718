// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "common/link/dds_transport.hpp"

#include "common/link/dds_entities.hpp"
#include "common/link/receive_side.hpp"
#include "common/link/send_queue.hpp"
#include "common/log/log.hpp"
#include "common/thread/bounded_queue.hpp"
#include "common/thread/worker.hpp"

#include <atomic>
#include <random>

namespace edgesplat::link {
namespace {

/// How long the link thread sleeps at most: only to give up messages that stand unfinished.
constexpr nanoseconds kExpiryPeriod = std::chrono::seconds(1);

std::uint64_t random_session() {
  std::random_device source;
  return (static_cast<std::uint64_t>(source()) << 32U) | source() | 1U;
}

class DdsTransport final : public Transport {
 public:
  DdsTransport(std::shared_ptr<DdsDomain> domain, const DdsTransportOptions& options, const Clock& clock)
      : domain_(std::move(domain)),
        role_(options.role),
        robot_(options.robot),
        session_(options.session != 0 ? options.session : random_session()),
        clock_(clock),
        sending_(session_, send_limits(domain_->config())),
        inbox_({domain_->config().inbox_messages}, thread::Overflow::kDropNewest),
        wake_([this] { sending_.wake(); }) {}

  ~DdsTransport() override { close(); }

  Status start() {
    EDGESPLAT_TRY(participant_, create_participant(domain_->config().domain));
    const Role far_end = role_ == Role::kRobot ? Role::kServer : Role::kRobot;
    for (const Lane lane : kLanes) {
      const auto at = static_cast<std::size_t>(lane);
      if (sends(role_, lane)) {
        EDGESPLAT_TRY(writers_[at], create_writer(participant_, role_, lane, &wake_));
      }
      if (receives(role_, lane)) {
        EDGESPLAT_TRY(readers_[at], create_reader(participant_, far_end, lane, &wake_));
      }
    }
    link_thread_.emplace("link", [this](const std::stop_token& stop) { return step(stop); });
    return {};
  }

  bool send(Lane lane, map::RobotId robot, std::vector<std::byte> bytes) override {
    if (lane == Lane::kAck || !sends(role_, lane)) return false;
    return sending_.push(lane, robot, std::move(bytes));
  }

  std::optional<Message> receive(nanoseconds timeout) override {
    auto message = inbox_.pop_for(timeout);
    if (message) sending_.wake();  // there is room again: what DDS holds back may come in
    return message;
  }

  [[nodiscard]] bool connected() const override { return connected_.load(); }

  [[nodiscard]] LinkCounters counters() const override {
    LinkCounters all = sending_.counters();
    const LinkCounters received = receiving_.counters();
    for (std::size_t i = 0; i < kLaneCount; ++i) {
      all[i].chunks_received = received[i].chunks_received;
      all[i].bytes_received = received[i].bytes_received;
      all[i].messages_received = received[i].messages_received;
      all[i].messages_corrupt = received[i].messages_corrupt;
      all[i].messages_lost = received[i].messages_lost;
    }
    return all;
  }

  bool drain(Lane lane, nanoseconds timeout) override { return sending_.drain(lane, timeout); }

  void close() override {
    sending_.close();
    inbox_.close();
    if (link_thread_) {
      link_thread_->request_stop();
      link_thread_->join();
    }
  }
  [[nodiscard]] bool finished() const override { return inbox_.finished(); }

 private:
  /// One turn of the link thread: take in what came, send one chunk, else sleep.
  bool step(const std::stop_token& stop) {
    if (stop.stop_requested()) return false;
    take_what_came();
    queue_acks();
    const LaneMask reachable = reachable_lanes();
    if (const auto part = sending_.next(reachable)) {
      send_part(*part);
    } else {
      sending_.wait_for_work(reachable, stop, kExpiryPeriod);
      receiving_.expire(clock_.now());
    }
    return true;
  }

  void take_what_came() {
    for (const Lane lane : kLanes) {
      const DdsEntity& reader = readers_[static_cast<std::size_t>(lane)];
      if (!reader.valid()) continue;
      const auto handle = [&](const ChunkHeader& header, std::span<const std::byte> payload) {
        if (role_ == Role::kRobot && header.robot != robot_) return;  // for another robot
        if (auto message = receiving_.add(lane, header, payload, clock_.now())) deliver(std::move(*message));
      };
      // With a full inbox the chunks stay in DDS, whose bounded cache then holds the sender back.
      while (has_room() && take_chunk(reader, handle)) {
      }
    }
  }

  [[nodiscard]] bool has_room() const { return inbox_.size() < domain_->config().inbox_messages; }

  void deliver(Message message) {
    if (message.lane != Lane::kAck) {
      (void)inbox_.push(
          std::move(message));  // has_room() was asked and nobody else pushes; refused only when closed
      return;
    }
    const auto ack = decode_ack(message.bytes);
    if (ack) {
      sending_.on_ack(*ack, message.robot, message.session);
    } else {
      EDGESPLAT_LOG_DEBUG("link", "bad acknowledgement", "why", ack.error().context);
    }
  }

  void queue_acks() {
    for (const auto& due : receiving_.take_due_acks()) {
      (void)sending_.push(Lane::kAck, due.robot, encode_ack(due.ack));
    }
  }

  LaneMask reachable_lanes() {
    LaneMask mask{};
    for (const Lane lane : kLanes) {
      const auto at = static_cast<std::size_t>(lane);
      mask[at] = writers_[at].valid() && has_reader(writers_[at]);
      if (mask[at] && !reachable_before_[at]) sending_.rewind(lane);
    }
    reachable_before_ = mask;
    const bool now = mask[static_cast<std::size_t>(role_ == Role::kRobot ? Lane::kKeyframe : Lane::kDelta)];
    if (connected_.exchange(now) != now) {
      EDGESPLAT_LOG_INFO("link", now ? "peer is there" : "peer is gone", "interface",
                         domain_->config().interface, "domain", domain_->config().domain);
    }
    return mask;
  }

  void send_part(const SendQueue::Part& part) {
    const auto outcome =
        write_chunk(writers_[static_cast<std::size_t>(part.lane)], part.header, part.payload);
    // On a time-out the same chunk is tried again: a train with a hole would be worth nothing.
    if (outcome == WriteOutcome::kTimeout) return sending_.count_write_timeout(part.lane);
    if (outcome == WriteOutcome::kRefused) sending_.count_write_failure(part.lane);
    sending_.advance(part.lane);
  }

  const std::shared_ptr<DdsDomain> domain_;
  const Role role_;
  const map::RobotId robot_;
  const std::uint64_t session_;
  const Clock& clock_;
  SendQueue sending_;
  ReceiveSide receiving_;
  thread::BoundedQueue<Message> inbox_;
  const WakeFunction wake_;
  std::atomic<bool> connected_ = false;
  LaneMask reachable_before_{};  ///< the link thread's own
  // From here on in the order of destruction's opposite: the thread ends first, then the DDS entities go.
  DdsEntity participant_;
  std::array<DdsEntity, kLaneCount> writers_;
  std::array<DdsEntity, kLaneCount> readers_;
  std::optional<thread::Worker> link_thread_;
};

}  // namespace

Result<std::unique_ptr<Transport>> open_dds_transport(std::shared_ptr<DdsDomain> domain,
                                                      const DdsTransportOptions& options,
                                                      const Clock& clock) {
  auto transport = std::make_unique<DdsTransport>(std::move(domain), options, clock);
  EDGESPLAT_TRY_STATUS(transport->start());
  return transport;
}

}  // namespace edgesplat::link
